// The segments of a tree that may lie in a box of the volume, found with bounded work. Pure.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "pipeline/vessels/clusters.h"
#include "pipeline/vessels/rigid_transform.h"

namespace octascope::ui {

// In the volume's frame (pipeline/vessels/registration.h).
struct NearSegment {
  glm::vec3 from_mm;
  glm::vec3 to_mm;
  float from_radius_mm; // where it starts (pipeline::segment_start_radius())
  float to_radius_mm;
  std::uint8_t order;
  pipeline::VesselBranch branch;

  float thickest_mm() const {
    return from_radius_mm > to_radius_mm ? from_radius_mm : to_radius_mm;
  }
};

struct VolumeBox {
  glm::vec3 lower_mm;
  glm::vec3 upper_mm;
};

// Every cluster's box is tested against the volume's; of those that meet it, the ones with the
// thickest vessels are looked into until most_examined segments were looked at, and the thickest
// most_segments of what was found stay.
//
// Threads: one at a time.
class NearSegments {
public:
  static constexpr std::size_t most_segments = 4096;
  static constexpr std::size_t most_examined = 1U << 17;

  // For trees of up to so many clusters. Allocates; find() does not.
  void reserve(std::size_t clusters);

  void find(const pipeline::VesselClusters& tree, const pipeline::RigidTransform& volume_from_tree,
            const VolumeBox& box);

  // In no order.
  std::span<const NearSegment> segments() const { return found_; }
  // Whether nothing was left out.
  bool complete() const { return complete_; }
  std::size_t examined() const { return examined_; } // segments

private:
  struct NearCluster {
    std::uint32_t index;
    float thickest_mm;
  };
  class Reach;

  void choose(const pipeline::VesselClusters& tree, const Reach& reach);
  void look_into(const pipeline::VesselClusters& tree, const pipeline::VesselCluster& cluster,
                 const Reach& reach);
  void keep_thickest();

  std::vector<NearCluster> near_;
  std::vector<NearSegment> found_;
  std::size_t examined_ = 0;
  bool complete_ = true;
};

} // namespace octascope::ui
