// The built-in control profiles: ui/controls/profiles/*.toml.
#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "hal/result.h"
#include "ui/controls/control_profile.h"

namespace octascope::ui {

// Every function with three switches and a knob.
inline constexpr std::string_view default_profile = "three_switch_pedal";

struct BuiltInProfile {
  std::string_view name; // as in the configuration
  std::string_view text; // TOML
};
std::span<const BuiltInProfile> built_in_profiles();

// ErrorCode::invalid_argument: unknown name; the message lists the known ones.
hal::Result<ControlProfile> built_in_profile(std::string_view name);

// The profile for the device "05f3:00ff". Models with one pedal and with three share an id: of
// several profiles, the one with that number of switches. Empty if there is none.
std::optional<ControlProfile> built_in_profile_for(std::string_view usb_id, int switches);

} // namespace octascope::ui
