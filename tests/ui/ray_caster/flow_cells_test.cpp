// Where the ray caster looks for what flows.
#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "ui/ray_caster/flow_cells.h"
#include "ui/transfer/flow_look.h"

namespace octascope::tests {
namespace {

constexpr pipeline::VolumeGeometry odd{37, 13, 6, 25, 60, 150};
constexpr pipeline::VolumeGeometry deep{203, 15, 3, 25, 60, 150}; // with whole blocks of still ones

// Few voxels are seen to flow, on borders, too; many nearly are.
std::vector<std::uint8_t> specks(const pipeline::VolumeGeometry& g) {
  std::vector<std::uint8_t> counts(g.voxels());
  std::uint32_t random = 1;
  for (std::uint8_t& count : counts) {
    random = random * 1664525U + 1013904223U;
    count = random >> 24U < 3 ? ui::first_seen_flow : static_cast<std::uint8_t>(random >> 25U);
  }
  counts.front() = counts.back() = 255;
  return counts;
}

std::span<const std::uint8_t> b_scan(const std::vector<std::uint8_t>& counts,
                                     const pipeline::VolumeGeometry& g, int b) {
  return std::span{counts}.subspan(static_cast<std::size_t>(b) * g.b_scan_voxels(),
                                   g.b_scan_voxels());
}

void take(ui::FlowCells& cells, const std::vector<std::uint8_t>& counts, int from, int to) {
  pipeline::FlowMarks marks{cells.geometry(), 0};
  for (int b = 0; b < cells.geometry().b_scans; ++b)
    marks.update(b, b_scan(counts, cells.geometry(), b));
  for (int b = from; b < to; ++b)
    cells.take(b, b_scan(counts, cells.geometry(), b), marks);
}

bool is_marked(const ui::FlowCells& cells, int z, int a, int b) {
  const std::uint32_t word =
      cells.marks()[b * cells.mark_slab() + a / 4 * cells.mark_row() + z / 8];
  return (word >> static_cast<unsigned>(a % 4 * 8 + z % 8) & 1U) != 0;
}

// Of a cell's corners, clamped to the volume.
std::uint8_t highest_corner(const std::vector<std::uint8_t>& counts,
                            const pipeline::VolumeGeometry& g, int z, int a, int b) {
  std::uint8_t highest = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const int at_z = std::min(z + (corner & 1), g.depths - 1);
    const int at_a = std::clamp(a - (corner >> 1 & 1), 0, g.a_scans - 1);
    const int at_b = std::clamp(b - (corner >> 2), 0, g.b_scans - 1);
    highest = std::max(
        highest, counts[static_cast<std::size_t>((at_b * g.a_scans + at_a) * g.depths + at_z)]);
  }
  return highest;
}

void expect_marks_of(const std::vector<std::uint8_t>& counts, const ui::FlowCells& cells) {
  const pipeline::VolumeGeometry& g = cells.geometry();
  int marked = 0;
  int wrong = 0;
  for (int b = 0; b <= g.b_scans; ++b)
    for (int a = 0; a <= g.a_scans; ++a)
      for (int z = 0; z < g.depths; ++z) {
        marked += is_marked(cells, z, a, b) ? 1 : 0;
        wrong +=
            is_marked(cells, z, a, b) != (highest_corner(counts, g, z, a, b) >= ui::first_seen_flow)
                ? 1
                : 0;
      }
  EXPECT_EQ(wrong, 0);
  EXPECT_GT(marked, 0);
}

TEST(FlowCells, marks_each_cell_with_a_corner_that_is_seen) {
  for (const pipeline::VolumeGeometry& geometry : {odd, deep}) {
    const auto counts = specks(geometry);
    ui::FlowCells cells{geometry};
    take(cells, counts, 0, geometry.b_scans);
    expect_marks_of(counts, cells);
  }
}

TEST(FlowCells, of_some_b_scans_are_renewed) {
  auto counts = specks(odd);
  ui::FlowCells cells{odd};
  take(cells, counts, 0, odd.b_scans);
  const auto changed = counts.begin() + static_cast<std::ptrdiff_t>(2 * odd.b_scan_voxels());
  std::fill_n(changed, 2 * odd.b_scan_voxels(), std::uint8_t{0});
  take(cells, counts, 1, 5);
  expect_marks_of(counts, cells);
}

// Others are left from the volume before.
TEST(FlowCells, have_the_counts_at_the_corners_of_marked_cells_with_the_last_bin_twice) {
  for (const pipeline::VolumeGeometry& g : {odd, deep}) {
    const auto counts = specks(g);
    ui::FlowCells cells{g};
    take(cells, std::vector<std::uint8_t>(g.voxels(), 255), 0, g.b_scans);
    take(cells, counts, 0, g.b_scans);
    const auto level_at = [&](int z, int a, int b) {
      return cells.counts()[b * cells.slab_bytes() + a * cells.column_bytes() + z];
    };
    int wrong = 0;
    for (int b = 0; b <= g.b_scans; ++b)
      for (int a = 0; a <= g.a_scans; ++a)
        for (int z = 0; z < g.depths; ++z) {
          if (!is_marked(cells, z, a, b))
            continue;
          for (const int at_b : {std::max(b - 1, 0), std::min(b, g.b_scans - 1)})
            for (const int at_a : {std::max(a - 1, 0), std::min(a, g.a_scans - 1)})
              for (const int at_z : {z, z + 1})
                wrong += level_at(at_z, at_a, at_b) !=
                                 b_scan(counts, g, at_b)[static_cast<std::size_t>(
                                     at_a * g.depths + std::min(at_z, g.depths - 1))]
                             ? 1
                             : 0;
        }
    EXPECT_EQ(wrong, 0);
  }
}

} // namespace
} // namespace octascope::tests
