#include "ui/view/vessel_placement.h"

#include <cmath>
#include <cstddef>
#include <numbers>

#include "pipeline/vessels/registration.h"

namespace octascope::ui {

using pipeline::Point;
using pipeline::RigidTransform;

namespace {

RigidTransform shift(const Point& by_mm) {
  RigidTransform moved;
  moved.shift_mm = by_mm;
  return moved;
}

Point opposite(const Point& p) {
  return {-p[0], -p[1], -p[2]};
}

Point centre_of(const pipeline::VolumeGeometry& g) {
  return {g.a_mm() / 2, g.b_mm() / 2, g.depth_mm() / 2};
}

// Right-handed about one axis.
RigidTransform turn(std::size_t axis, double degrees) {
  const double angle = degrees * std::numbers::pi / 180;
  const std::size_t first = (axis + 1) % 3;
  const std::size_t second = (axis + 2) % 3;
  RigidTransform turned;
  turned.rotation[first][first] = turned.rotation[second][second] = std::cos(angle);
  turned.rotation[second][first] = std::sin(angle);
  turned.rotation[first][second] = -std::sin(angle);
  return turned;
}

RigidTransform nudged(const VesselNudge& nudge, const Point& centre) {
  const Point by{nudge.shift_mm[0], nudge.shift_mm[1], nudge.shift_mm[2]};
  return shift(by) * shift(centre) * turn(2, nudge.turn_deg[2]) * turn(1, nudge.turn_deg[1]) *
         turn(0, nudge.turn_deg[0]) * shift(opposite(centre));
}

} // namespace

RigidTransform volume_from_tree(const PlacedVessels& vessels, const VesselNudge& nudge,
                                const pipeline::VolumeGeometry& geometry) {
  const Point centre = centre_of(geometry);
  const RigidTransform placed =
      vessels.volume_from_tree.value_or(shift(centre) * shift(opposite(vessels.centre_mm)));
  return nudge.any() ? nudged(nudge, centre) * placed : placed;
}

glm::mat4 world_from_tree(const PlacedVessels& vessels, const VesselNudge& nudge,
                          const pipeline::VolumeGeometry& geometry) {
  const RigidTransform t =
      pipeline::world_from_volume(geometry) * volume_from_tree(vessels, nudge, geometry);
  glm::mat4 world{1};
  for (glm::length_t row = 0; row < 3; ++row) {
    const auto& from = t.rotation[static_cast<std::size_t>(row)];
    for (glm::length_t column = 0; column < 3; ++column)
      world[column][row] = static_cast<float>(from[static_cast<std::size_t>(column)]);
    world[3][row] = static_cast<float>(t.shift_mm[static_cast<std::size_t>(row)]);
  }
  return world;
}

} // namespace octascope::ui
