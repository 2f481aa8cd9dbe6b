// Small branching vessels inside a tissue.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "sim/phantoms/phantom_column.h"

namespace octascope::sim {

struct VesselPoint {
  float x_mm = 0;
  float y_mm = 0;
  float depth_mm = 0; // below the tissue's surface, so that vessels follow it
};

struct VesselSegment {
  VesselPoint from;
  VesselPoint to;
  float radius_mm = 0;
};

struct VesselGrowth {
  float smallest_part = 1.0F / 3; // of the root's radius: thinner branches end
  float steepness = 0.12F;        // the greatest slope, up or down
  float lowest_mm = 1e3F;         // depths that it keeps above
};

// Grows a winding tree from `root` towards `heading_rad` (0: along x), forking until its branches
// are too thin. Radii at forks obey Murray's law. Blood flows from each segment's `from` to its
// `to`.
std::vector<VesselSegment> grow_vessels(VesselPoint root, float heading_rad, float radius_mm,
                                        float length_mm, std::uint64_t seed,
                                        const VesselGrowth& growth = {});

// Vessel segments in a grid of cells, for fast lookup by column. Immutable, thread-safe.
class VesselBed {
public:
  VesselBed() = default;
  explicit VesselBed(std::vector<VesselSegment> segments);

  // Adds the lumens at (x, y) to a column whose tissue begins at `surface_mm`, as flowing layers
  // like `blood`, whose depths are ignored. They flow as scatterer_motion.h says. Nothing below `deepest_mm`.
  void fill(Column& column, float x_mm, float y_mm, float surface_mm, float deepest_mm,
            const Layer& blood) const;

  // As given: depths below the surface.
  std::span<const VesselSegment> segments() const { return segments_; }

  // For the view from above: visibility of a vessel at (x, y), 0 … 1, decreasing with depth.
  float visibility(float x_mm, float y_mm, float sight_mm) const;

private:
  template <class Visit> void for_each_cell_near(const VesselSegment& s, const Visit& visit) const;
  std::span<const VesselSegment> segments_near(float x_mm, float y_mm) const;

  std::vector<VesselSegment> segments_;
  float x_min_mm_ = 0;
  float y_min_mm_ = 0;
  int columns_ = 0;
  int rows_ = 0;
  std::vector<std::uint32_t> first_of_cell_; // rows × columns + 1
  std::vector<VesselSegment> of_cells_;
};

// Appends a bed's segments with their depths below the first depth bin. `surface(x, y)` is the
// tissue's there; nothing: there is none, and the segments at that place are left out.
template <class Surface>
void append_below(std::vector<VesselSegment>& to, const VesselBed& bed, const Surface& surface) {
  for (VesselSegment s : bed.segments()) {
    const std::optional<float> from = surface(s.from.x_mm, s.from.y_mm);
    const std::optional<float> end = surface(s.to.x_mm, s.to.y_mm);
    if (!from || !end)
      continue;
    s.from.depth_mm += *from;
    s.to.depth_mm += *end;
    to.push_back(s);
  }
}

} // namespace octascope::sim
