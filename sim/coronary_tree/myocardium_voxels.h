// The muscle as cubes of equal size, and which artery feeds each.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "sim/coronary_tree/heart/main_courses.h"
#include "sim/coronary_tree/heart/region.h"

namespace octascope::sim {

inline constexpr double cell_mm = 0.8;

// The centres of all cubes whose centre is muscle.
std::vector<Vector3> myocardium_voxels();

// Sorts cells by the artery that feeds them: the nearest one, with the distances to the courses
// shifted so that each artery gets its share. Returns the number of cells of each. Cells of one
// artery keep their order.
std::array<std::size_t, 3> share_out(std::vector<Vector3>& cells,
                                     const std::array<Course, 3>& courses,
                                     const std::array<double, 3>& shares);

// `count` places, spread evenly over those cells and within each.
std::vector<Vector3> places_in_cells(std::span<const Vector3> cells, std::size_t count,
                                     std::uint64_t key);

} // namespace octascope::sim
