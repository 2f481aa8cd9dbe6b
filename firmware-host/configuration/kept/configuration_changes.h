// What of a new configuration a running appliance can take over, and what has to wait for a
// restart.
#pragma once

#include <string>
#include <vector>

#include "firmware-host/configuration/configuration.h"
#include "ui/transfer/transfer_set.h"
#include "ui/view/view_state.h"

namespace octascope::firmware_host {

// Sections of what differs and cannot be changed in a running appliance, as the file names them:
// "[scan]"; each once. Pure: of files that are named only the names are compared.
std::vector<std::string> changes_for_a_restart(const Configuration& used,
                                               const Configuration& next);

// Do both offer the same? By name and by what they do at 256 places of the window.
bool same_transfers(const ui::TransferSet& a, const ui::TransferSet& b);

// The view with what `next` says otherwise than `used`; what pedal and knob have set stays
// elsewhere. Choices go by name; one that is no longer there becomes `next`'s own.
ui::ViewState with_changes(const ui::ViewState& view, const Configuration& used,
                           const Configuration& next);

} // namespace octascope::firmware_host
