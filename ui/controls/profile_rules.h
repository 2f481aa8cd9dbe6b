// Which bindings of a control profile contradict each other.
#pragma once

#include "pipeline/files/config_document.h"
#include "ui/controls/control_profile.h"

namespace octascope::ui {

// Complains about `table`, a [[bind]], if it contradicts a binding read before it.
void check(pipeline::ConfigTable& table, const ControlProfile& before, const SwitchAction& bound);
void check(pipeline::ConfigTable& table, const ControlProfile& before, const KnobAction& bound);
void check(pipeline::ConfigTable& table, const ControlProfile& before, const AxisAction& bound);

// Complains about `root` if the profile as a whole has actions that could never be reached.
void check_whole(pipeline::ConfigTable& root, const ControlProfile& profile);

} // namespace octascope::ui
