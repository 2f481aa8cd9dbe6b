// The built-in control profiles: ui/controls/profiles/*.toml.
#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "hal/result.h"
#include "ui/controls/control_profile.h"

namespace octascope::ui {

// Offers every function with three switches and a knob.
inline constexpr std::string_view default_profile = "three_switch_pedal";

struct BuiltInProfile {
  std::string_view name; // as in the configuration
  std::string_view text; // TOML
};
std::span<const BuiltInProfile> built_in_profiles();

// ErrorCode::invalid_argument: no such profile; the message lists the existing ones.
hal::Result<ControlProfile> built_in_profile(std::string_view name);

// The profile for a device id such as "05f3:00ff". One-pedal and three-pedal models can share an
// id; `switches` then decides between their profiles. Empty if there is none.
std::optional<ControlProfile> built_in_profile_for(std::string_view usb_id, int switches);

} // namespace octascope::ui
