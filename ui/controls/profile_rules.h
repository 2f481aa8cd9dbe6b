// Checks for contradictory bindings in a control profile.
#pragma once

#include "pipeline/files/config_document.h"
#include "ui/controls/control_profile.h"

namespace octascope::ui {

// Reports an error on `table`, a [[bind]], if it contradicts a binding read before it.
void check(pipeline::ConfigTable& table, const ControlProfile& before, const SwitchAction& bound);
void check(pipeline::ConfigTable& table, const ControlProfile& before, const KnobAction& bound);
void check(pipeline::ConfigTable& table, const ControlProfile& before, const AxisAction& bound);

// Reports an error on `root` if the profile as a whole has actions that can never be reached.
void check_whole(pipeline::ConfigTable& root, const ControlProfile& profile);

} // namespace octascope::ui
