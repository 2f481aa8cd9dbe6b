#include "firmware-host/commands/bench/flow/true_vessels.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

#include "pipeline/vessels/tree_node.h"

namespace octascope::firmware_host {

namespace {

using Place = std::array<double, 3>;

} // namespace

pipeline::VesselTree vessels_within(const pipeline::VolumeGeometry& geometry,
                                    const sim::Phantom& phantom) {
  const Place size{geometry.a_mm(), geometry.b_mm(), geometry.depth_mm()};
  // The phantom's origin is in the middle of the field and of the first depth's voxels.
  const Place origin{size[0] / 2, size[1] / 2, geometry.depth_spacing_um / 2000};
  const auto placed = [&](const sim::VesselPoint& p) {
    return Place{origin[0] + double{p.x_mm}, origin[1] + double{p.y_mm},
                 origin[2] + double{p.depth_mm}};
  };
  pipeline::VesselTree tree;
  for (const sim::VesselSegment& segment : phantom.vessels()) {
    const Place from = placed(segment.from);
    const Place to = placed(segment.to);
    double begin = 0; // of the part within, relative to the segment
    double end = 1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double way = to[axis] - from[axis];
      double enters = -from[axis];
      double leaves = size[axis] - from[axis];
      if (way == 0) {
        end = enters > 0 || leaves < 0 ? -1 : end;
        continue;
      }
      enters /= way;
      leaves /= way;
      if (way < 0)
        std::swap(enters, leaves);
      begin = std::max(begin, enters);
      end = std::min(end, leaves);
    }
    if (begin >= end)
      continue;
    const auto between = [&](double part) {
      Place at{};
      for (std::size_t axis = 0; axis < 3; ++axis)
        at[axis] = from[axis] + part * (to[axis] - from[axis]);
      return at;
    };
    add_node(tree, between(begin), segment.radius_mm, pipeline::no_parent);
    add_node(tree, between(end), segment.radius_mm, static_cast<std::uint32_t>(tree.nodes() - 1));
  }
  return tree;
}

} // namespace octascope::firmware_host
