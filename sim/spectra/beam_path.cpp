#include "sim/spectra/beam_path.h"

#include <cmath>
#include <numbers>

namespace octascope::sim {

BeamPlace BeamPath::at(int sweep, int line) const {
  const double a = a_scan_at(sweep, line) - (plan_.a_scans - 1) / 2.0;
  const double b = plan_.b_scan_of(sweep) - (plan_.b_scans - 1) / 2.0;
  return {static_cast<float>(a * plan_.a_spacing_um * 1e-3),
          static_cast<float>(b * plan_.b_spacing_um * 1e-3)};
}

double BeamPath::a_scan_at(int sweep, int line) const {
  if (plan_.bidirectional)
    return there_and_back(static_cast<double>(sweep) * plan_.lines_per_frame() + line - lag_lines_);
  if (line < plan_.a_scans)
    return line;
  const double t = (line - plan_.a_scans + 1.0) / (plan_.fly_back_lines + 1.0);
  return (plan_.a_scans - 1) * (0.5 + 0.5 * std::cos(std::numbers::pi * t));
}

double BeamPath::there_and_back(double lines_since_start) const {
  const double frame = plan_.lines_per_frame();
  const double sweep = std::floor(lines_since_start / frame);
  const double last = plan_.a_scans - 1;
  double way = lines_since_start - sweep * frame;
  if (way > last) {
    const double turning = plan_.turn_around_lines + 1.0; // lines, from full speed to full speed
    const double since = way - last;
    way = last + since - since * since / turning;
  }
  return std::fmod(sweep, 2.0) == 0 ? way : last - way;
}

} // namespace octascope::sim
