// Where something is seen to flow, against brute force.
#include <algorithm>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "pipeline/volume/flow_marks.h"

namespace octascope::pipeline {
namespace {

// Few are marked, on borders, too; many nearly are.
std::vector<std::uint8_t> speckled_flow(const VolumeGeometry& g) {
  std::vector<std::uint8_t> counts(g.b_scan_voxels());
  std::uint32_t random = 1;
  for (std::uint8_t& count : counts) {
    random = random * 1664525U + 1013904223U;
    count = random >> 24U < 3 ? first_marked_flow : static_cast<std::uint8_t>(random >> 25U);
  }
  counts.front() = counts.back() = 255;
  return counts;
}

bool is_marked_in(const FlowMarks& marks, int b, int z, int a) {
  const std::uint32_t word = marks.of(b)[static_cast<std::size_t>(a / 4 * marks.row() + z / 8)];
  return (word >> static_cast<unsigned>(a % 4 * 8 + z % 8) & 1U) != 0;
}

// Of the cell's corners in the B-scan, clamped to it.
bool has_marked_corner(const std::vector<std::uint8_t>& counts, const VolumeGeometry& g, int z,
                       int a, int first_depth) {
  for (int corner = 0; corner < 4; ++corner) {
    const int at_z = std::min(z + (corner & 1), g.depths - 1);
    const int at_a = std::clamp(a - (corner >> 1), 0, g.a_scans - 1);
    if (at_z >= first_depth &&
        counts[static_cast<std::size_t>(at_a * g.depths + at_z)] >= first_marked_flow)
      return true;
  }
  return false;
}

TEST(FlowMarks, are_of_each_cell_with_a_corner_that_is_marked) {
  for (const VolumeGeometry& g :
       {VolumeGeometry{37, 13, 2, 25, 60, 150}, VolumeGeometry{203, 15, 2, 25, 60, 150},
        VolumeGeometry{128, 16, 2, 25, 60, 150}})
    for (const int first_depth : {0, 2, 8}) {
      const auto counts = speckled_flow(g);
      FlowMarks marks{g, first_depth};
      marks.update(1, counts);
      int marked = 0;
      int wrong = 0;
      for (int a = 0; a <= g.a_scans; ++a)
        for (int z = 0; z < g.depths; ++z) {
          const bool is = is_marked_in(marks, 1, z, a);
          marked += is ? 1 : 0;
          wrong += is != has_marked_corner(counts, g, z, a, first_depth) ? 1 : 0;
        }
      EXPECT_EQ(wrong, 0) << g.depths << " from " << first_depth;
      EXPECT_GT(marked, 0);
      EXPECT_TRUE(std::ranges::all_of(marks.of(0), [](std::uint32_t word) { return word == 0; }));
    }
}

TEST(FlowMarks, of_a_b_scan_are_made_anew_cleared_and_copied) {
  const VolumeGeometry g{37, 13, 2, 25, 60, 150};
  FlowMarks marks{g, 2};
  marks.update(0, std::vector<std::uint8_t>(g.b_scan_voxels(), 255));
  marks.update(0, speckled_flow(g));
  marks.update(1, speckled_flow(g));
  EXPECT_TRUE(std::ranges::equal(marks.of(0), marks.of(1))) << "nothing is left of what was there";
  FlowMarks other{g, 2};
  other.copy(1, marks);
  EXPECT_TRUE(std::ranges::equal(other.of(1), marks.of(1)));
  other.clear(1);
  EXPECT_TRUE(std::ranges::equal(other.of(1), other.of(0)));
}

} // namespace
} // namespace octascope::pipeline
