// What may stand beside what in a profile of controls.
#pragma once

#include "pipeline/files/config_document.h"
#include "ui/controls/control_profile.h"

namespace octascope::ui {

// Complains about `table`, a [[bind]], where it does not go with what was read before it.
void check(pipeline::ConfigTable& table, const ControlProfile& before, const SwitchAction& bound);
void check(pipeline::ConfigTable& table, const ControlProfile& before, const KnobAction& bound);
void check(pipeline::ConfigTable& table, const ControlProfile& before, const AxisAction& bound);

// Complains about `root` where the profile as a whole holds what could never be reached.
void check_whole(pipeline::ConfigTable& root, const ControlProfile& profile);

} // namespace octascope::ui
