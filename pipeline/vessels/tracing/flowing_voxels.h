// What flows in a grid: connected sets of voxels.
//
// Hysteresis thresholds (Canny, IEEE PAMI 8, 1986): a voxel belongs to a vessel if its smoothed flow
// is at least `low` and it is connected, by faces, edges or corners, to one of at least `high`.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <stop_token>
#include <vector>

#include "pipeline/vessels/tracing/flow_grid.h"

namespace octascope::pipeline {

struct FlowThresholds {
  float low = 0.3F;
  float high = 0.5F;
  std::size_t fewest_voxels = 20; // of a component; smaller ones are noise
};

// Voxels are named by their place in `cells`. Cells are those of the grid with a border of one
// around, so that each voxel has 26 neighbours.
class FlowingVoxels {
public:
  static constexpr std::uint32_t none = 0xFFFFFFFF;

  // Replaces what was found before, and takes its memory. Once `stop` is requested it leaves soon, with
  // what is of no use.
  void find(const FlowGrid& grid, const FlowThresholds& thresholds, const std::stop_token& stop);

  std::size_t size() const { return cells_.size(); }
  // Components one after the other: where each begins, and the end of the last. In a component a
  // voxel comes before those that are more steps from its first one.
  const std::vector<std::uint32_t>& components() const { return components_; }

  std::uint32_t cell_of(std::uint32_t voxel) const { return cells_[voxel]; }
  // none: it does not flow.
  std::uint32_t voxel_at(std::size_t cell) const { return voxel_of_[cell]; }
  std::uint32_t voxel_around(const Point& at_um,
                             const FlowGrid& grid) const; // none outside as well
  std::array<int, 3> place(std::uint32_t voxel) const;    // x, y, z in the grid
  Point middle_um(std::uint32_t voxel) const;
  // 0 where it is unknown: a hole that was filled.
  double flow_of(const FlowGrid& grid, std::uint32_t voxel) const;

  // To the next cell along each axis.
  std::array<std::ptrdiff_t, 3> steps() const { return {counts_[2], counts_[2] * counts_[0], 1}; }

  // Calls visit(voxel, from the centre in µm) for each within the radius.
  template <class Visit>
  void within(const Point& centre_um, double radius_um, const Visit& visit) const;

  // Flow of all voxels of at least the lower threshold, those of small components as well.
  double all_flow() const { return all_flow_; }
  // Mean flow of what is known and does not flow, as a share of that of what does: 0 where vessels
  // stand out, near 1 in noise. 1 if nothing flows.
  double background_share(const FlowGrid& grid) const;

private:
  void set_shape(const FlowGrid& grid);
  void mark(const FlowGrid& grid, const FlowThresholds& thresholds);
  void fill_holes();
  void flood(std::uint32_t cell);

  std::array<std::ptrdiff_t, 3> counts_{}; // with the border
  std::array<double, 3> spacing_um_{};
  std::array<std::ptrdiff_t, 26> neighbours_{};
  std::vector<std::uint32_t> voxel_of_; // by cell
  std::vector<std::uint32_t> cells_;    // by voxel
  std::vector<std::uint32_t> components_{0};
  double all_flow_ = 0;
};

template <class Visit>
void FlowingVoxels::within(const Point& centre_um, double radius_um, const Visit& visit) const {
  std::array<std::ptrdiff_t, 3> from{};
  std::array<std::ptrdiff_t, 3> to{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double middle = centre_um[axis] / spacing_um_[axis] + 0.5; // in cells
    const double reach = radius_um / spacing_um_[axis];
    const auto last = static_cast<double>(counts_[axis] - 2);
    from[axis] = static_cast<std::ptrdiff_t>(std::ceil(std::fmax(middle - reach, 1.0)));
    to[axis] = static_cast<std::ptrdiff_t>(std::floor(std::fmin(middle + reach, last)));
  }
  const double square = radius_um * radius_um;
  for (std::ptrdiff_t y = from[1]; y <= to[1]; ++y) {
    const double dy = (static_cast<double>(y) - 0.5) * spacing_um_[1] - centre_um[1];
    for (std::ptrdiff_t x = from[0]; x <= to[0]; ++x) {
      const double dx = (static_cast<double>(x) - 0.5) * spacing_um_[0] - centre_um[0];
      const double left = square - dx * dx - dy * dy;
      if (left < 0)
        continue;
      const std::uint32_t* line =
          &voxel_of_[static_cast<std::size_t>((y * counts_[0] + x) * counts_[2])];
      for (std::ptrdiff_t z = from[2]; z <= to[2]; ++z) {
        if (line[z] == none)
          continue;
        const double dz = (static_cast<double>(z) - 0.5) * spacing_um_[2] - centre_um[2];
        if (dz * dz <= left)
          visit(line[z], Point{dx, dy, dz});
      }
    }
  }
}

} // namespace octascope::pipeline
