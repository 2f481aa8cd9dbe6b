// Lists the display hardware, for choosing an output and for `devices` and `doctor`.
#pragma once

#include <string>
#include <vector>

#include "hal/linux/kms/drm/topology.h"
#include "hal/linux/system/file_descriptor.h"

namespace octascope::hal::linux_backend::kms {

// "/dev/dri/card0", … by number.
std::vector<std::string> card_nodes();

// Probes every connector, which may take 0.1 s each. Does not need to be the card's master. A card
// without outputs (render-only) has its `problem` set.
Card read_card(const FileDescriptor& file, const std::string& node);

// Briefly opens every card. A card that cannot be opened has its `problem` set. To explain what is
// missing, use the Error of choose_output() for the result.
std::vector<Card> survey();

} // namespace octascope::hal::linux_backend::kms
