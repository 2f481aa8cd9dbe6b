// A flight through a vessel tree, along which methods are compared: what is still right from frame
// to frame, and not in three pictures alone.
#pragma once

#include <vector>

#include <glm/vec3.hpp>

#include "pipeline/vessels/clusters.h"
#include "ui/vessels/view/vessel_view.h"

namespace octascope::ui {

// From the whole tree to a close look, 4 µm a pixel: to the mouth of the LAD (of the longest vessel
// where no branch is named so) and along its longest way down to the last vessel of order 5, half
// turned around it meanwhile. The nearer, the slower: a step of t moves the picture by about as
// many pixels anywhere, and makes it larger by the same factor. It depends on the tree and the
// picture's size alone.
class VesselFlight {
public:
  // `tree` with its sources; without, and without vessels of order 5, it comes close where it
  // begins. For commands: allocates.
  VesselFlight(const pipeline::VesselClusters& tree, int width, int height);

  // t from 0 to 1.
  VesselView at(float t) const;

  float length_mm() const { return reached_mm_.back(); }
  // By how many pixels the picture moves from beginning to end: its middle, or, where there is
  // nothing to fly along, its edge.
  float pixels() const;

private:
  void fly_to(const glm::vec3& place_mm);
  glm::vec3 place(float reached_mm) const;
  float closer() const; // the picture's scale at the end, of that at the beginning

  VesselView whole_;
  int height_;
  std::vector<glm::vec3> course_mm_;
  std::vector<float> reached_mm_; // from the beginning to each place of the course
};

} // namespace octascope::ui
