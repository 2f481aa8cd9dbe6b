#include "firmware-host/commands/level_picture.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace octascope::firmware_host {

namespace {

float percentile(std::vector<float>& values, double share) {
  const auto nth =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), nth, values.end());
  return *nth;
}

} // namespace

pipeline::Image draw_b_scan(std::span<const float> levels_db, int depths, int a_scans) {
  const auto columns = static_cast<std::size_t>(a_scans);
  const auto rows = static_cast<std::size_t>(depths);
  const std::size_t skipped_rows = rows / 100;
  std::vector<float> judged;
  judged.reserve(levels_db.size());
  for (std::size_t a = 0; a < columns; ++a) {
    const auto profile = levels_db.subspan(a * rows + skipped_rows, rows - skipped_rows);
    judged.insert(judged.end(), profile.begin(), profile.end());
  }
  const float black = percentile(judged, 0.5);
  const float white = std::max(percentile(judged, 0.999), black + 1); // dB

  pipeline::Image image{a_scans, depths, 1};
  for (std::size_t a = 0; a < columns; ++a) {
    for (std::size_t z = 0; z < rows; ++z) {
      const float grey = 255 * (levels_db[a * rows + z] - black) / (white - black);
      image.pixels[z * columns + a] =
          static_cast<std::uint8_t>(std::lround(std::clamp(grey, 0.0F, 255.0F)));
    }
  }
  return image;
}

} // namespace octascope::firmware_host
