// Divides the muscle on both sides of an artery along its course.
#pragma once

#include <vector>

#include "sim/coronary_tree/heart/main_courses.h"
#include "sim/coronary_tree/heart/region.h"

namespace octascope::sim {

// Hands out the cells of a region from the beginning of a course to its end, always from the side
// that lags behind. Cells handed out lie at the front of the region.
class CourseRegions {
public:
  CourseRegions(Region region, const Course& course);

  // Number of cells before this distance along the course, handed out or not.
  std::size_t before(double along_mm) const;

  std::size_t handed_out() const { return handed_out_; }

  // Hands out the next `count` cells of one side, or of the other if it runs out, into the region
  // behind those handed out before.
  void hand_out(std::size_t count);

private:
  struct Cell {
    Vector3 place;
    double along_mm;
  };

  Region region_;
  std::vector<Cell> sides_[2]; // in the order of the course
  std::size_t next_[2] = {0, 0};
  std::size_t handed_out_ = 0;
};

} // namespace octascope::sim
