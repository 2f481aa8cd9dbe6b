// A flight through a vessel tree, for comparing methods from frame to frame instead of only in
// three pictures.
#pragma once

#include <vector>

#include <glm/vec3.hpp>

#include "pipeline/vessels/clusters.h"
#include "ui/vessels/view/vessel_view.h"

namespace octascope::ui {

// From the whole tree to a close look at 4 µm per pixel: to the mouth of the LAD (without named
// branches, of the longest vessel) and along its longest path down to the last vessel of order 5,
// with half a turn around it. It slows down as it comes closer: everywhere, a step of t moves the
// picture by about the same number of pixels and enlarges it by the same factor. Depends only on
// the tree and the picture's size.
class VesselFlight {
public:
  // `tree` needs its sources. Without them, or without vessels of order 5, the flight approaches
  // the point where it begins. Allocates: for commands.
  VesselFlight(const pipeline::VesselClusters& tree, int width, int height);

  // t from 0 to 1.
  VesselView at(float t) const;

  float length_mm() const { return reached_mm_.back(); }
  // The movement of the picture in pixels from beginning to end: of its middle, or, if there is no
  // path to fly along, of its edge.
  float pixels() const;

private:
  void fly_to(const glm::vec3& place_mm);
  glm::vec3 place(float reached_mm) const;
  float closer() const; // scale of the picture at the end, relative to the beginning

  VesselView whole_;
  int height_;
  std::vector<glm::vec3> course_mm_;
  std::vector<float> reached_mm_; // path length from the beginning to each place of the course
};

} // namespace octascope::ui
