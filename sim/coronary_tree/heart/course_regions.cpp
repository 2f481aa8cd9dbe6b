#include "sim/coronary_tree/heart/course_regions.h"

#include <algorithm>

#include "sim/coronary_tree/heart/heart_wall.h"

namespace octascope::sim {

CourseRegions::CourseRegions(Region region, const Course& course) : region_{region} {
  for (const Vector3& place : region) {
    const double along = course.nearest(place).along_mm;
    const Vector3 on_course = course.at(along);
    const Vector3 left = cross(course.direction(along), epicardium_outward(on_course));
    sides_[dot(place - on_course, left) < 0].push_back({place, along});
  }
  for (auto& side : sides_)
    std::ranges::stable_sort(side,
                             [](const Cell& a, const Cell& b) { return a.along_mm < b.along_mm; });
}

std::size_t CourseRegions::before(double along_mm) const {
  std::size_t count = 0;
  for (const auto& side : sides_)
    count += static_cast<std::size_t>(
        std::partition_point(side.begin(), side.end(),
                             [&](const Cell& cell) { return cell.along_mm < along_mm; }) -
        side.begin());
  return count;
}

void CourseRegions::hand_out(std::size_t count) {
  const auto left = [this](std::size_t side) { return sides_[side].size() - next_[side]; };
  std::size_t side = 0;
  if (left(0) == 0 || (left(1) > 0 && sides_[1][next_[1]].along_mm < sides_[0][next_[0]].along_mm))
    side = 1;
  for (; count > 0 && left(0) + left(1) > 0; --count) {
    if (left(side) == 0)
      side = 1 - side;
    region_[handed_out_++] = sides_[side][next_[side]++].place;
  }
}

} // namespace octascope::sim
