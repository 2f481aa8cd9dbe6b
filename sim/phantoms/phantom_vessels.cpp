#include "sim/phantoms/phantom_vessels.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "sim/phantoms/scatterer_motion.h"
#include "sim/spectrometer/noise.h"

namespace octascope::sim {
namespace {

constexpr float cell_mm = 0.15F;

struct Branch {
  VesselPoint at;
  float heading_rad;
  float radius_mm;
  float length_mm;
};

LumenFlow flow_of(const VesselSegment& s) {
  const float dx = s.to.x_mm - s.from.x_mm;
  const float dy = s.to.y_mm - s.from.y_mm;
  const float dz = s.to.depth_mm - s.from.depth_mm;
  const float level = std::sqrt(dx * dx + dy * dy);
  const float speed = static_cast<float>(wall_shear_per_s) / 2 * s.radius_mm /
                      std::max(std::sqrt(level * level + dz * dz), 1e-6F);
  return {.radius_mm = s.radius_mm, .across_mm_per_s = speed * level, .along_mm_per_s = speed * dz};
}

// −1 … 1
float signed_unit(std::uint64_t key) {
  return static_cast<float>(2 * unit_interval(key) - 1);
}

// Distance, seen from above, to the segment's axis, and the axis' depth there.
struct Nearest {
  float distance_mm;
  float depth_mm;
};

Nearest nearest_on(const VesselSegment& s, float x_mm, float y_mm) {
  const float dx = s.to.x_mm - s.from.x_mm;
  const float dy = s.to.y_mm - s.from.y_mm;
  const float along =
      ((x_mm - s.from.x_mm) * dx + (y_mm - s.from.y_mm) * dy) / std::max(dx * dx + dy * dy, 1e-12F);
  const float t = std::clamp(along, 0.0F, 1.0F);
  const float off_x = x_mm - s.from.x_mm - t * dx;
  const float off_y = y_mm - s.from.y_mm - t * dy;
  return {std::sqrt(off_x * off_x + off_y * off_y),
          s.from.depth_mm + t * (s.to.depth_mm - s.from.depth_mm)};
}

} // namespace

std::vector<VesselSegment> grow_vessels(VesselPoint root, float heading_rad, float radius_mm,
                                        float length_mm, std::uint64_t seed,
                                        const VesselGrowth& growth) {
  constexpr int steps = 8; // segments of a branch
  std::vector<VesselSegment> segments;
  std::vector<Branch> open{{root, heading_rad, radius_mm, length_mm}};
  std::uint64_t key = hash(seed, 0x7e55);
  while (!open.empty()) {
    Branch branch = open.back();
    open.pop_back();
    for (int i = 0; i < steps; ++i) {
      branch.heading_rad += 0.28F * signed_unit(++key);
      const float step_mm = branch.length_mm / steps;
      const VesselPoint next{
          branch.at.x_mm + step_mm * std::cos(branch.heading_rad),
          branch.at.y_mm + step_mm * std::sin(branch.heading_rad),
          std::clamp(branch.at.depth_mm + growth.steepness * step_mm * signed_unit(++key),
                     1.5F * branch.radius_mm, growth.lowest_mm)};
      segments.push_back({branch.at, next, branch.radius_mm});
      branch.at = next;
    }
    // Murray (1926): r³ = r₁³ + r₂³; the thinner branch turns away more.
    const float share = 0.5F + 0.25F * signed_unit(++key);
    const float side = signed_unit(++key) < 0 ? -1.0F : 1.0F;
    for (const auto& [part, turn] :
         {std::pair{share, 0.9F * (1 - share)}, std::pair{1 - share, -0.9F * share}}) {
      const float radius = branch.radius_mm * std::cbrt(part);
      if (radius > growth.smallest_part * radius_mm)
        open.push_back(
            {branch.at, branch.heading_rad + side * turn, radius, branch.length_mm * 0.8F});
    }
  }
  return segments;
}

VesselBed::VesselBed(std::vector<VesselSegment> segments) : segments_{std::move(segments)} {
  if (segments_.empty())
    return;
  constexpr float far = std::numeric_limits<float>::max();
  float x_max = -far;
  float y_max = -far;
  x_min_mm_ = y_min_mm_ = far;
  for (const VesselSegment& s : segments_) {
    x_min_mm_ = std::min({x_min_mm_, s.from.x_mm - s.radius_mm, s.to.x_mm - s.radius_mm});
    y_min_mm_ = std::min({y_min_mm_, s.from.y_mm - s.radius_mm, s.to.y_mm - s.radius_mm});
    x_max = std::max({x_max, s.from.x_mm + s.radius_mm, s.to.x_mm + s.radius_mm});
    y_max = std::max({y_max, s.from.y_mm + s.radius_mm, s.to.y_mm + s.radius_mm});
  }
  columns_ = static_cast<int>((x_max - x_min_mm_) / cell_mm) + 1;
  rows_ = static_cast<int>((y_max - y_min_mm_) / cell_mm) + 1;
  // Counted before they are put in place: an eye has ten thousands, each in several cells.
  first_of_cell_.resize(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_) + 1);
  for (const VesselSegment& s : segments_)
    for_each_cell_near(s, [&](std::size_t cell) { ++first_of_cell_[cell + 1]; });
  std::partial_sum(first_of_cell_.begin(), first_of_cell_.end(), first_of_cell_.begin());
  std::vector<std::uint32_t> next{first_of_cell_.begin(), first_of_cell_.end() - 1};
  of_cells_.resize(first_of_cell_.back());
  for (const VesselSegment& s : segments_)
    for_each_cell_near(s, [&](std::size_t cell) { of_cells_[next[cell]++] = s; });
}

template <class Visit>
void VesselBed::for_each_cell_near(const VesselSegment& s, const Visit& visit) const {
  const auto index = [](float position, float origin) {
    return static_cast<int>((position - origin) / cell_mm);
  };
  const float reach = s.radius_mm;
  const int first_column = index(std::min(s.from.x_mm, s.to.x_mm) - reach, x_min_mm_);
  const int last_column = index(std::max(s.from.x_mm, s.to.x_mm) + reach, x_min_mm_);
  const int first_row = index(std::min(s.from.y_mm, s.to.y_mm) - reach, y_min_mm_);
  const int last_row = index(std::max(s.from.y_mm, s.to.y_mm) + reach, y_min_mm_);
  for (int row = std::max(first_row, 0); row <= std::min(last_row, rows_ - 1); ++row) {
    for (int column = std::max(first_column, 0); column <= std::min(last_column, columns_ - 1);
         ++column) {
      const float x = x_min_mm_ + (static_cast<float>(column) + 0.5F) * cell_mm;
      const float y = y_min_mm_ + (static_cast<float>(row) + 0.5F) * cell_mm;
      if (nearest_on(s, x, y).distance_mm <= reach + 0.7072F * cell_mm)
        visit(static_cast<std::size_t>(row * columns_ + column));
    }
  }
}

std::span<const VesselSegment> VesselBed::segments_near(float x_mm, float y_mm) const {
  const float column = (x_mm - x_min_mm_) / cell_mm;
  const float row = (y_mm - y_min_mm_) / cell_mm;
  if (!(column >= 0 && row >= 0) || column >= static_cast<float>(columns_) ||
      row >= static_cast<float>(rows_))
    return {};
  const auto cell =
      static_cast<std::size_t>(static_cast<int>(row) * columns_ + static_cast<int>(column));
  return std::span{of_cells_}.subspan(first_of_cell_[cell],
                                      first_of_cell_[cell + 1] - first_of_cell_[cell]);
}

void VesselBed::fill(Column& column, float x_mm, float y_mm, float surface_mm, float deepest_mm,
                     const Layer& blood) const {
  // Segments end in half balls, so that their joints close.
  for (const VesselSegment& s : segments_near(x_mm, y_mm)) {
    const Nearest nearest = nearest_on(s, x_mm, y_mm);
    if (nearest.distance_mm >= s.radius_mm)
      continue;
    const float half_height =
        std::sqrt(s.radius_mm * s.radius_mm - nearest.distance_mm * nearest.distance_mm);
    Layer lumen = blood;
    lumen.flowing = true;
    lumen.top_mm = surface_mm + nearest.depth_mm - half_height;
    lumen.bottom_mm = std::min(surface_mm + nearest.depth_mm + half_height, deepest_mm);
    lumen.flow = flow_of(s);
    lumen.flow.axis_mm = surface_mm + nearest.depth_mm;
    lumen.flow.aside_mm = nearest.distance_mm;
    column.add(lumen);
  }
}

float VesselBed::visibility(float x_mm, float y_mm, float sight_mm) const {
  float most = 0;
  for (const VesselSegment& s : segments_near(x_mm, y_mm)) {
    const Nearest nearest = nearest_on(s, x_mm, y_mm);
    const float edge = std::clamp(1.5F - 1.5F * nearest.distance_mm / s.radius_mm, 0.0F, 1.0F);
    most = std::max(most, edge * std::exp(-nearest.depth_mm / sight_mm));
  }
  return most;
}

} // namespace octascope::sim
