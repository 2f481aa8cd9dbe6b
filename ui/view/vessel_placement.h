// Where a vessel tree lies in the volume. Pure.
#pragma once

#include <array>
#include <optional>

#include <glm/mat4x4.hpp>

#include "pipeline/vessels/clusters.h"
#include "pipeline/vessels/rigid_transform.h"
#include "pipeline/volume/volume_geometry.h"

namespace octascope::ui {

// By how much the surgeon has moved the tree, in the volume's frame (pipeline/vessels/
// registration.h): first turned about the volume's centre, about x, then y, then z, then shifted.
struct VesselNudge {
  std::array<float, 3> shift_mm{};
  std::array<float, 3> turn_deg{};

  bool any() const { return *this != VesselNudge{}; }
  bool operator==(const VesselNudge&) const = default;
};

// A tree and its registration. The tree is borrowed.
struct PlacedVessels {
  pipeline::VesselClusters tree;
  pipeline::Point centre_mm{};                              // of its bounds, in its own frame
  std::optional<pipeline::RigidTransform> volume_from_tree; // empty: not registered
};

// The tree's place in the volume's frame. An unregistered tree is centred in the volume, unscaled
// and unturned.
pipeline::RigidTransform volume_from_tree(const PlacedVessels& vessels, const VesselNudge& nudge,
                                          const pipeline::VolumeGeometry& geometry);

// The same, in world axes (ui/view/camera.h).
glm::mat4 world_from_tree(const PlacedVessels& vessels, const VesselNudge& nudge,
                          const pipeline::VolumeGeometry& geometry);

} // namespace octascope::ui
