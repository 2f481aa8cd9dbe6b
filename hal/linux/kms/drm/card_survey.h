// What display hardware is there: for the choice of an output, and for `devices` and `doctor`.
#pragma once

#include <string>
#include <vector>

#include "hal/linux/kms/drm/topology.h"
#include "hal/linux/system/file_descriptor.h"

namespace octascope::hal::linux_backend::kms {

// "/dev/dri/card0", … by number; empty where there is none.
std::vector<std::string> card_nodes();

// Asks every connector anew, which may take a tenth of a second each. Needs no special right on the
// open file. A card that shows nothing (a render-only one) has its `problem` set.
Card read_card(const FileDescriptor& file, const std::string& node);

// Opens every card for a moment. A card that must not be opened has its `problem` set. For a
// verdict in words: choose_output() of the result, whose Error says what is missing.
std::vector<Card> survey();

} // namespace octascope::hal::linux_backend::kms
