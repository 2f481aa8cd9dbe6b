// What may be leapt over, against brute force.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "tests/ui/support/synthetic_volume.h"
#include "ui/ray_caster/brick_grid.h"
#include "ui/ray_caster/step_table.h"
#include "ui/work_team.h"

namespace octascope::tests {
namespace {

constexpr pipeline::VolumeGeometry geometry{100, 61, 33, 10, 10, 10};

TEST(BrickGrid, distances_are_to_the_nearest_brick_that_is_not_empty) {
  pipeline::Volume volume = uniform_volume(geometry, 0);
  volume.b_scan(3)[20 * 100 + 90] = 200;
  volume.b_scan(30)[55 * 100 + 7] = 200;
  pipeline::Occupancy occupancy{geometry, 0};
  occupancy.update(volume);
  ui::ViewState view;
  const auto transfer = std::make_unique<ui::TransferTable>();
  ui::make_window_table(view, *transfer);
  const auto levels = std::make_unique<ui::VisibleLevels>();
  ui::find_visible_levels(*transfer, *levels);
  ui::BrickGrid grid;
  grid.update(occupancy, *levels, ui::Visibility::range);

  const pipeline::BrickCounts n = grid.counts();
  struct Place {
    int z, a, b;
  };
  // Cells that touch a speck: along depth the bin's and the one above, else the voxel's and the
  // next.
  std::vector<Place> specks;
  for (const Place& voxel : {Place{90, 20, 3}, Place{7, 55, 30}})
    for (int cell = 0; cell < 8; ++cell)
      specks.push_back({(voxel.z - (cell & 1)) >> pipeline::brick_depth_shift,
                        (voxel.a + (cell >> 1 & 1)) >> pipeline::brick_a_shift,
                        (voxel.b + (cell >> 2)) >> pipeline::brick_b_shift});
  for (int b = 0; b < n.b; ++b)
    for (int a = 0; a < n.a; ++a)
      for (int z = 0; z < n.depth; ++z) {
        int nearest = ui::BrickGrid::most_distance;
        for (const Place& speck : specks)
          nearest = std::min(nearest, std::max({std::abs(speck.z - z), std::abs(speck.a - a),
                                                std::abs(speck.b - b)}));
        const auto found = grid.data()[(b * n.a + a) * n.depth + z];
        EXPECT_EQ(found & 0xFF, nearest) << z << ' ' << a << ' ' << b;
        EXPECT_EQ(found >> 8, nearest == 0 ? 200 : 0) << z << ' ' << a << ' ' << b;
      }
}

TEST(TransferTable, is_empty_exactly_where_the_window_is) {
  ui::ViewState view;
  view.window_offset_db = 0; // level 80
  view.window_size_db = 20;
  const auto transfer = std::make_unique<ui::TransferTable>();
  ui::make_window_table(view, *transfer);
  const auto table = std::make_unique<ui::StepTable>();
  ui::make_step_table(*transfer, 0.25F, *table);
  EXPECT_TRUE(table->visible.empty(0, 80));
  EXPECT_FALSE(table->visible.empty(0, 81));
  EXPECT_FALSE(table->visible.empty(255, 255));
  EXPECT_TRUE(table->grey);
  // Halfway up: grey 0.5, opacity 0.25 over a reference step.
  constexpr std::size_t middle = 100 * ui::TransferTable::entries_per_level;
  EXPECT_NEAR((table->opacity_and_red[middle] & 0xFFFFU) / 65535.0, 0.5, 1e-5);
  EXPECT_NEAR((table->opacity_and_red[middle] >> 16U) / 65535.0, 1 - std::pow(0.75, 0.25), 1e-5);
}

TEST(WorkTeam, does_every_piece_once_turn_after_turn) {
  ui::WorkTeam team{3, {}};
  std::vector<std::atomic<int>> done(257);
  for (std::uint32_t turn = 0; turn < 2000; ++turn) {
    const std::uint32_t pieces = turn % 257;
    team.run(pieces, [&](std::uint32_t i) { done[i].fetch_add(1, std::memory_order_relaxed); });
    for (std::uint32_t i = 0; i < done.size(); ++i)
      ASSERT_EQ(done[i].exchange(0), i < pieces ? 1 : 0) << i << " of " << pieces;
  }
}

} // namespace
} // namespace octascope::tests
