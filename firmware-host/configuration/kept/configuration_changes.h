// Which configuration changes a running appliance can take over, and which need a restart.
#pragma once

#include <string>
#include <vector>

#include "firmware-host/configuration/configuration.h"
#include "ui/transfer/transfer_set.h"
#include "ui/view/view_state.h"

namespace octascope::firmware_host {

// The sections that differ and need a restart, as named in the file: "[scan]"; each once. Pure:
// named files are compared by name only.
std::vector<std::string> changes_for_a_restart(const Configuration& used,
                                               const Configuration& next);

// Whether both sets are the same, by name and by value at 256 places of the window.
bool same_transfers(const ui::TransferSet& a, const ui::TransferSet& b);

// The view with the changes from `used` to `next` applied; all else keeps the values set by pedal
// and knob. Choices are matched by name; one that no longer exists becomes `next`'s own.
ui::ViewState with_changes(const ui::ViewState& view, const Configuration& used,
                           const Configuration& next);

} // namespace octascope::firmware_host
