#include "ui/controls/built_in_profiles.h"

#include <algorithm>
#include <array>
#include <string>

#include "embedded_profiles.h"

namespace octascope::ui {

std::span<const BuiltInProfile> built_in_profiles() {
  static const std::array all{
      BuiltInProfile{"three_switch_pedal", profiles::three_switch_pedal_toml},
      BuiltInProfile{"philips_pedal", profiles::philips_pedal_toml},
      BuiltInProfile{"pcsensor_single", profiles::pcsensor_single_toml},
      BuiltInProfile{"pcsensor_triple", profiles::pcsensor_triple_toml},
      BuiltInProfile{"powermate", profiles::powermate_toml},
      BuiltInProfile{"shuttle_xpress", profiles::shuttle_xpress_toml},
      BuiltInProfile{"shuttle_pro", profiles::shuttle_pro_toml},
      BuiltInProfile{"space_mouse", profiles::space_mouse_toml},
      BuiltInProfile{"surface_dial", profiles::surface_dial_toml},
      BuiltInProfile{"keyboard", profiles::keyboard_toml},
  };
  return all;
}

hal::Result<ControlProfile> built_in_profile(std::string_view name) {
  const auto all = built_in_profiles();
  const auto found = std::ranges::find(all, name, &BuiltInProfile::name);
  if (found != all.end())
    return ControlProfile::parse(found->text, std::string{name} + ".toml");
  std::string known;
  for (const BuiltInProfile& profile : all)
    known += (known.empty() ? "" : ", ") + std::string{profile.name};
  return hal::fail(
      hal::ErrorCode::invalid_argument,
      "control profile \"{}\" is not known, expected one of {}; for one of your own, give its file",
      name, known);
}

std::optional<ControlProfile> built_in_profile_for(std::string_view usb_id, int switches) {
  std::optional<ControlProfile> made_for_it;
  for (const BuiltInProfile& built_in : built_in_profiles()) {
    auto profile = ControlProfile::parse(built_in.text, std::string{built_in.name} + ".toml");
    if (!profile || std::ranges::find(profile->usb, usb_id) == profile->usb.end())
      continue;
    if (static_cast<int>(profile->switches.size()) == switches)
      return std::move(*profile);
    if (!made_for_it)
      made_for_it = std::move(*profile);
  }
  return made_for_it;
}

} // namespace octascope::ui
