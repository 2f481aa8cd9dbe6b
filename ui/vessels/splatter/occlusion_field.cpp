#include "ui/vessels/splatter/occlusion_field.h"

#include <algorithm>
#include <cmath>

namespace octascope::ui {

namespace {

constexpr int taps = 2 * occlusion_reach + 1;
// Of a row that is gathered, at a time: enough to be worth the margins.
constexpr int most_cells = 128;
// Of a cell's rows, those that are looked at.
constexpr std::array looked_at{0, 2};
constexpr float per_pixel = 1.0F / (occlusion_cell * looked_at.size());

// A tent: 1, 2 … 7 … 2, 1.
constexpr std::array<float, taps> weights = [] {
  std::array<float, taps> made{};
  constexpr int top = occlusion_reach + 1;
  for (int i = 0; i < taps; ++i) {
    const int off = i < occlusion_reach ? occlusion_reach - i : i - occlusion_reach;
    made[static_cast<std::size_t>(i)] = static_cast<float>(top - off) / (top * top);
  }
  return made;
}();

using Margined = std::array<std::array<float, most_cells + taps>, 3>;

void add_pixel(const DepthImage& sharp, int x, int y, float origin_mm, std::array<float, 3>& sum) {
  const float distance = sharp.distance_mm(x, y);
  if (std::isinf(distance))
    return;
  const float from_origin = distance - origin_mm;
  sum[0] += per_pixel;
  sum[1] += per_pixel * from_origin;
  sum[2] += per_pixel * from_origin * from_origin;
}

std::array<float, 3> cell(const DepthImage& sharp, int column, int row, float origin_mm) {
  std::array<float, 3> sum{};
  for (const int dy : looked_at) {
    const int y = std::min(row * occlusion_cell + dy, sharp.height - 1);
    for (int dx = 0; dx < occlusion_cell; ++dx)
      add_pixel(sharp, std::min(column * occlusion_cell + dx, sharp.width - 1), y, origin_mm, sum);
  }
  return sum;
}

} // namespace

void OcclusionField::resize(int width, int height, float origin_mm) {
  columns_ = (width + occlusion_cell - 1) / occlusion_cell;
  rows_ = (height + occlusion_cell - 1) / occlusion_cell;
  origin_mm_ = origin_mm;
  const auto cells = static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_);
  for (Planes* planes : {&gathered_, &spread_})
    for (std::vector<float>& plane : *planes)
      if (plane.size() < cells)
        plane.resize(cells);
}

void OcclusionField::gather(const DepthImage& sharp, int first, int end) {
  Margined cells;
  for (int row = first; row < end; ++row)
    for (int left = 0; left < columns_; left += most_cells) {
      const int count = std::min(most_cells, columns_ - left);
      for (int i = 0; i < count + taps - 1; ++i) {
        const int column = std::clamp(left + i - occlusion_reach, 0, columns_ - 1);
        const auto sum = cell(sharp, column, row, origin_mm_);
        for (std::size_t k = 0; k < sum.size(); ++k)
          cells[k][static_cast<std::size_t>(i)] = sum[k];
      }
      for (std::size_t k = 0; k < cells.size(); ++k) {
        float* to = gathered_[k].data() + static_cast<std::ptrdiff_t>(row) * columns_ + left;
        std::fill_n(to, count, 0.0F);
        for (int tap = 0; tap < taps; ++tap)
          for (int i = 0; i < count; ++i)
            to[i] += weights[static_cast<std::size_t>(tap)] *
                     cells[k][static_cast<std::size_t>(i + tap)];
      }
    }
}

void OcclusionField::spread(int first, int end) {
  for (int row = first; row < end; ++row)
    for (std::size_t k = 0; k < spread_.size(); ++k) {
      float* to = spread_[k].data() + static_cast<std::ptrdiff_t>(row) * columns_;
      std::fill_n(to, columns_, 0.0F);
      for (int tap = 0; tap < taps; ++tap) {
        const int from = std::clamp(row + tap - occlusion_reach, 0, rows_ - 1);
        const float* line = gathered_[k].data() + static_cast<std::ptrdiff_t>(from) * columns_;
        for (int i = 0; i < columns_; ++i)
          to[i] += weights[static_cast<std::size_t>(tap)] * line[i];
      }
    }
}

} // namespace octascope::ui
