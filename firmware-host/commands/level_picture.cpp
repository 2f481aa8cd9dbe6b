#include "firmware-host/commands/level_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "pipeline/volume/level_scale.h"
#include "ui/panels/projection.h"

namespace octascope::firmware_host {

namespace {

float percentile(std::vector<float>& values, double share) {
  const auto nth =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), nth, values.end());
  return *nth;
}

std::uint8_t grey_in(const ui::DisplayWindow& window, float count) {
  const float share = (pipeline::level_db(count) - window.offset_db) / window.size_db;
  return static_cast<std::uint8_t>(std::lround(255 * std::clamp(share, 0.0F, 1.0F)));
}

constexpr int longest_side = 16384; // as of a picture that is rendered

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

pipeline::Image draw_b_scan(const pipeline::Volume& volume, int b_scan,
                            const ui::DisplayWindow& window) {
  std::array<std::uint8_t, 256> greys{};
  for (std::size_t count = 0; count < greys.size(); ++count)
    greys[count] = grey_in(window, static_cast<float>(count));
  const auto columns = static_cast<std::size_t>(volume.geometry.a_scans);
  const auto rows = static_cast<std::size_t>(volume.geometry.depths);
  const auto counts = volume.b_scan(b_scan);
  pipeline::Image image{volume.geometry.a_scans, volume.geometry.depths, 1};
  for (std::size_t a = 0; a < columns; ++a) {
    for (std::size_t z = 0; z < rows; ++z)
      image.pixels[z * columns + a] = greys[counts[a * rows + z]];
  }
  return image;
}

pipeline::Image draw_en_face(const pipeline::Volume& volume,
                             const std::optional<ui::DisplayWindow>& window) {
  pipeline::Image image{volume.geometry.a_scans, volume.geometry.b_scans, 1};
  pipeline::Occupancy occupancy{volume.geometry, pipeline::blank_depth_bins};
  occupancy.update(volume);
  ui::TissueMap tissue;
  tissue.update(occupancy, volume.b_scan_states);
  ui::project_slab(volume, tissue, image.pixels);
  if (window)
    std::ranges::transform(image.pixels, image.pixels.begin(), [&](std::uint8_t level) {
      return grey_in(*window, static_cast<float>(level));
    });
  else
    ui::stretch_contrast(volume, image.pixels);
  return image;
}

hal::Result<pipeline::Image> to_scale(const pipeline::Image& grey, double column_spacing,
                                      double row_spacing) {
  const double pixel = std::min(column_spacing, row_spacing);
  const double width = std::max(1.0, std::round(grey.width * column_spacing / pixel));
  const double height = std::max(1.0, std::round(grey.height * row_spacing / pixel));
  if (!(width <= longest_side && height <= longest_side))
    return hal::fail(hal::ErrorCode::invalid_argument,
                     "to scale, the picture would have {:.0f}×{:.0f} pixels, expected at most {} "
                     "either way; without --to-scale it has {}×{}",
                     width, height, longest_side, grey.width, grey.height);
  pipeline::Image image{static_cast<int>(width), static_cast<int>(height), 1};
  const auto nearest = [](int at, int of, int source) {
    return static_cast<std::size_t>((2 * std::int64_t{at} + 1) * source / (2 * std::int64_t{of}));
  };
  auto pixel_out = image.pixels.begin();
  for (int y = 0; y < image.height; ++y) {
    const std::size_t row =
        nearest(y, image.height, grey.height) * static_cast<std::size_t>(grey.width);
    for (int x = 0; x < image.width; ++x)
      *pixel_out++ = grey.pixels[row + nearest(x, image.width, grey.width)];
  }
  return image;
}

} // namespace octascope::firmware_host
