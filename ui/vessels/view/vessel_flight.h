// A flight through a vessel tree, to compare methods from frame to frame instead of in three
// pictures only.
#pragma once

#include <vector>

#include <glm/vec3.hpp>

#include "pipeline/vessels/clusters.h"
#include "ui/vessels/view/vessel_view.h"

namespace octascope::ui {

// From the whole tree to a close view of 4 µm a pixel: to the mouth of the LAD (of the longest
// vessel if no branch has that name) and along its longest path down to the last vessel of order 5,
// turning half around it. A step of t moves the picture by about the same number of pixels
// everywhere, and magnifies it by the same factor. Depends only on the tree and the picture's size.
class VesselFlight {
public:
  // `tree` with its sources; without them, or without vessels of order 5, it zooms in where it
  // begins. For commands: allocates.
  VesselFlight(const pipeline::VesselClusters& tree, int width, int height);

  // t from 0 to 1.
  VesselView at(float t) const;

  float length_mm() const { return reached_mm_.back(); }
  // How many pixels the picture moves from beginning to end: its middle or, if there is no path,
  // its edge.
  float pixels() const;

private:
  void fly_to(const glm::vec3& place_mm);
  glm::vec3 place(float reached_mm) const;
  float closer() const; // the final scale relative to the initial one

  VesselView whole_;
  int height_;
  std::vector<glm::vec3> course_mm_;
  std::vector<float> reached_mm_; // from the beginning to each place of the course
};

} // namespace octascope::ui
