#include "sim/spectra/tissue_motion.h"

#include <cmath>
#include <numbers>
#include <string_view>

namespace octascope::sim {
namespace {

constexpr std::size_t most_tones = 8;
constexpr double most_um = 200;
constexpr double most_hz = 10'000;

double sum_of(const std::vector<MotionTone>& tones, double t_s) {
  double sum = 0;
  double begin_rad = 0;
  for (const MotionTone& tone : tones) {
    sum += tone.amplitude_um * std::sin(2 * std::numbers::pi * tone.frequency_hz * t_s + begin_rad);
    begin_rad += 2.4;
  }
  return sum;
}

hal::Result<> check(std::string_view name, const std::vector<MotionTone>& tones) {
  if (tones.size() > most_tones)
    return hal::fail(hal::ErrorCode::invalid_argument, "{} has {} tones, expected at most {}", name,
                     tones.size(), most_tones);
  for (const MotionTone& tone : tones)
    if (!(tone.amplitude_um >= 0 && tone.amplitude_um <= most_um && tone.frequency_hz >= 0 &&
          tone.frequency_hz <= most_hz))
      return hal::fail(hal::ErrorCode::invalid_argument,
                       "{} has a tone of {} µm at {} Hz, expected 0 to {} µm at 0 to {} Hz", name,
                       tone.amplitude_um, tone.frequency_hz, most_um, most_hz);
  return {};
}

} // namespace

hal::Result<> TissueMotion::validate() const {
  HAL_CHECK(check("axial_motion", axial));
  return check("lateral_motion", lateral);
}

double TissueMotion::axial_um(double t_s) const {
  return sum_of(axial, t_s);
}

double TissueMotion::lateral_um(double t_s) const {
  return sum_of(lateral, t_s);
}

} // namespace octascope::sim
