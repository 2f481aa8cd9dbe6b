#include "sim/spectrometer/noise.h"

#include <cmath>
#include <numbers>

namespace octascope::sim {
namespace {

struct Cell {
  std::uint64_t index;
  float blend;
};

Cell cell_of(float position) {
  const float lower = std::floor(position);
  const float t = position - lower;
  return {static_cast<std::uint64_t>(static_cast<std::int64_t>(lower)), t * t * (3 - 2 * t)};
}

float corner(std::uint64_t row_key, std::uint64_t index) {
  return static_cast<float>(static_cast<std::int32_t>(hash(row_key ^ index) >> 32U)) * 0x1p-31F;
}

float blended_row(std::uint64_t row_key, const Cell& x) {
  return std::lerp(corner(row_key, x.index), corner(row_key, x.index + 1), x.blend);
}

float blended_plane(std::uint64_t plane_key, const Cell& x, const Cell& y) {
  return std::lerp(blended_row(hash(plane_key ^ y.index), x),
                   blended_row(hash(plane_key ^ (y.index + 1)), x), y.blend);
}

} // namespace

GaussianTable::GaussianTable(std::uint64_t seed, int size_log2, std::size_t longest_run)
    : mask_((std::size_t{1} << static_cast<unsigned>(size_log2)) - 1),
      values_(mask_ + 1 + longest_run) {
  // Box and Muller (1958), two numbers from two uniform ones.
  for (std::size_t i = 0; i <= mask_; i += 2) {
    const double radius = std::sqrt(-2 * std::log(1 - unit_interval(hash(seed, i))));
    const double angle = 2 * std::numbers::pi * unit_interval(hash(seed, i + 1));
    values_[i] = static_cast<float>(radius * std::cos(angle));
    values_[i + 1] = static_cast<float>(radius * std::sin(angle));
  }
  for (std::size_t i = mask_ + 1; i < values_.size(); ++i)
    values_[i] = values_[i & mask_];
}

float smooth_noise(std::uint64_t seed, float x, float y) {
  return blended_plane(hash(seed), cell_of(x), cell_of(y));
}

float smooth_noise(std::uint64_t seed, float x, float y, float z) {
  const Cell depth = cell_of(z);
  const Cell cx = cell_of(x);
  const Cell cy = cell_of(y);
  return std::lerp(blended_plane(hash(seed, depth.index), cx, cy),
                   blended_plane(hash(seed, depth.index + 1), cx, cy), depth.blend);
}

float rough_noise(std::uint64_t seed, float x, float y) {
  return (4 * smooth_noise(seed, x, y) + 2 * smooth_noise(seed + 1, 2 * x, 2 * y) +
          smooth_noise(seed + 2, 4 * x, 4 * y)) /
         7;
}

} // namespace octascope::sim
