// Small branching vessels inside a tissue.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sim/phantoms/phantom_column.h"

namespace octascope::sim {

struct VesselPoint {
  float x_mm = 0;
  float y_mm = 0;
  float depth_mm = 0; // below the tissue's surface, which vessels follow
};

struct VesselSegment {
  VesselPoint from;
  VesselPoint to;
  float radius_mm = 0;
};

// A tree that begins at `root`, winds towards `heading_rad` (0: along x), and forks until its
// branches are thinner than a third of `radius_mm`. At a fork the radii obey Murray's law.
std::vector<VesselSegment> grow_vessels(VesselPoint root, float heading_rad, float radius_mm,
                                        float length_mm, std::uint64_t seed);

// Segments in a grid of cells, so that those at a column are found quickly. Immutable, thread-safe.
class VesselBed {
public:
  VesselBed() = default;
  explicit VesselBed(std::vector<VesselSegment> segments);

  // Adds the lumens at (x, y) to a column whose tissue begins at `surface_mm`, as flowing layers
  // like `blood`, whose depths are ignored. Nothing below `deepest_mm`.
  void fill(Column& column, float x_mm, float y_mm, float surface_mm, float deepest_mm,
            const Layer& blood) const;

  // For the view from above: the visibility of vessels at (x, y), 0 … 1, fainter with depth.
  float visibility(float x_mm, float y_mm, float sight_mm) const;

private:
  template <class Visit> void for_each_cell_near(const VesselSegment& s, const Visit& visit) const;
  std::span<const VesselSegment> segments_near(float x_mm, float y_mm) const;

  float x_min_mm_ = 0;
  float y_min_mm_ = 0;
  int columns_ = 0;
  int rows_ = 0;
  std::vector<std::uint32_t> first_of_cell_; // rows × columns + 1
  std::vector<VesselSegment> of_cells_;
};

} // namespace octascope::sim
