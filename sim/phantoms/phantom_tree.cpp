#include "sim/phantoms/phantom_tree.h"

#include <array>
#include <cstdint>
#include <map>
#include <utility>

#include "pipeline/vessels/vessel_orders.h"

namespace octascope::sim {
namespace {

using Position = std::array<float, 3>;

class TreeMaker {
public:
  void add(const VesselSegment& s) {
    const Position from = position(s.from);
    auto start = nodes_.find(from);
    if (start == nodes_.end())
      start = nodes_.emplace(from, add_node(from, s.radius_mm, pipeline::no_parent)).first;
    const Position to = position(s.to);
    nodes_.emplace(to, add_node(to, s.radius_mm, start->second));
  }

  pipeline::VesselTree take() {
    pipeline::assign_vessel_orders(tree_);
    return std::move(tree_);
  }

private:
  static Position position(const VesselPoint& p) { return {p.x_mm, p.y_mm, p.depth_mm}; }

  std::uint32_t add_node(const Position& at, float radius_mm, std::uint32_t parent) {
    tree_.positions_mm.push_back(at);
    tree_.radii_mm.push_back(radius_mm);
    tree_.parents.push_back(parent);
    tree_.branches.push_back(pipeline::VesselBranch::unknown);
    return static_cast<std::uint32_t>(tree_.nodes() - 1);
  }

  pipeline::VesselTree tree_;
  std::map<Position, std::uint32_t> nodes_; // that vessels may go on from
};

} // namespace

PhantomTree phantom_tree(const Phantom& phantom) {
  const pipeline::VolumeGeometry geometry = phantom.suggested_plan().geometry();
  // The phantom's origin is in the middle of the field and of the first depth's voxels.
  const pipeline::Point origin{geometry.a_mm() / 2, geometry.b_mm() / 2,
                               geometry.depth_spacing_um / 2000};
  const auto in_field = [&](const VesselPoint& p) {
    const pipeline::Point at{origin[0] + double{p.x_mm}, origin[1] + double{p.y_mm},
                             origin[2] + double{p.depth_mm}};
    return at[0] > 0 && at[0] < geometry.a_mm() && at[1] > 0 && at[1] < geometry.b_mm() &&
           at[2] > 0 && at[2] < geometry.depth_mm();
  };
  TreeMaker maker;
  for (const VesselSegment& s : phantom.vessels())
    if (in_field(s.from) && in_field(s.to))
      maker.add(s);
  PhantomTree made;
  made.tree = maker.take();
  made.volume_from_tree.shift_mm = origin;
  return made;
}

} // namespace octascope::sim
