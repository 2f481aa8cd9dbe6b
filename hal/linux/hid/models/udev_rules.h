// The udev rules that let octascope open its controls and GPIO chips without being root: made from
// the list of controls, so that the two cannot disagree (deploy/70-octascope.rules is this text).
#pragma once

#include <string>
#include <vector>

#include "hal/linux/hid/models/control_model.h"

namespace octascope::hal::linux_backend {

std::string udev_rules(const std::vector<ControlModel>& models = listed_control_models());

} // namespace octascope::hal::linux_backend
