#include "sim/coronary_tree/trunk_spacing.h"

#include "sim/coronary_tree/heart/heart_wall.h"
#include "sim/coronary_tree/spacing/relaxation.h"
#include "sim/coronary_tree/spacing/segments.h"

namespace octascope::sim {
namespace {

void add_node(pipeline::VesselTree& tree, Vector3 place, double diameter_um, std::uint32_t parent,
              std::size_t order) {
  tree.positions_mm.push_back(
      {static_cast<float>(place.x), static_cast<float>(place.y), static_cast<float>(place.z)});
  tree.radii_mm.push_back(static_cast<float>(diameter_um / 2000));
  tree.parents.push_back(parent);
  tree.orders.push_back(static_cast<std::uint8_t>(order));
}

// The node of the mother from which an element springs, counted from the artery's root.
std::size_t joint_node(const TrunkPlan& plan, const GrownTrunk& grown, std::size_t element) {
  const PlannedElement& planned = plan.elements[element];
  return 1 + grown.elements[planned.mother].first_node + planned.joint;
}

void add_artery(pipeline::VesselTree& tree, const TrunkPlan& plan, const GrownTrunk& grown) {
  const std::size_t root = tree.nodes();
  add_node(tree, grown.root, grown.root_um, pipeline::no_parent, plan.elements[0].order);
  for (std::size_t i = 0; i < plan.elements.size(); ++i) {
    const PlannedElement& element = plan.elements[i];
    std::size_t parent = root + (i == 0 ? 0 : joint_node(plan, grown, i));
    for (std::size_t k = 0; element.is_trunk() && k < element.segments; ++k) {
      const TrunkNode& node = grown.nodes[grown.elements[i].first_node + k];
      add_node(tree, node.place, node.diameter_um, static_cast<std::uint32_t>(parent),
               element.order);
      parent = tree.nodes() - 1;
    }
  }
}

} // namespace

Vector3 held_in_place(Vector3 place, std::size_t order) {
  constexpr double farthest_outside_mm = 2.5;
  if (order < lowest_outer_order)
    return held_in_muscle(place);
  return depth_mm(place) < -farthest_outside_mm && place.y < base_mm
             ? held_at_depth(place, -farthest_outside_mm)
             : place;
}

void space_trunks(const std::array<TrunkPlan, 3>& plans, std::array<GrownTrunk, 3>& grown,
                  std::size_t threads) {
  pipeline::VesselTree tree;
  std::vector<bool> still; // the arteries themselves: their courses are smooth
  for (std::size_t b = 0; b < 3; ++b) {
    add_artery(tree, plans[b], grown[b]);
    for (std::size_t i = 0; i < plans[b].elements.size(); ++i)
      still.insert(still.end(), plans[b].elements[i].segments + (i == 0),
                   plans[b].elements[i].on_course);
  }
  relax(tree, still, {.rounds = 40, .unbending_rounds = 30, .threads = threads}, held_in_place, {});
  std::uint32_t root = 0;
  for (std::size_t b = 0; b < 3; ++b) {
    for (std::size_t i = 0; i < grown[b].nodes.size(); ++i)
      grown[b].nodes[i].place = node_place(tree, root + 1 + static_cast<std::uint32_t>(i));
    for (std::size_t i = 1; i < grown[b].elements.size(); ++i)
      grown[b].elements[i].start =
          node_place(tree, root + static_cast<std::uint32_t>(joint_node(plans[b], grown[b], i)));
    root += 1 + static_cast<std::uint32_t>(grown[b].nodes.size());
  }
}

} // namespace octascope::sim
