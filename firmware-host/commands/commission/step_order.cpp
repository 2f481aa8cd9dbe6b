#include "firmware-host/commands/commission/step_order.h"

#include <array>

namespace octascope::firmware_host {

namespace {

constexpr std::array<std::string_view, 1> scan{"camera"};
constexpr std::array<std::string_view, 2> light{"camera", "spectrum"}; // exposure and gain
constexpr std::array<std::string_view, 4> captures{"dark", "mirror_near", "mirror_far", "tissue"};
constexpr std::array<std::string_view, 2> picture{"camera", "calibration"};
constexpr std::array<std::string_view, 6> all{"camera",      "trigger", "spectrum",
                                              "calibration", "target",  "pedal"};

} // namespace

std::span<const std::string_view> made_of(std::string_view step) {
  if (step == "trigger" || step == "spectrum")
    return scan;
  if (step == "dark" || step == "mirror_near" || step == "mirror_far" || step == "tissue")
    return light;
  if (step == "calibration")
    return captures;
  if (step == "target")
    return picture;
  if (step == "configuration")
    return all;
  return {};
}

} // namespace octascope::firmware_host
