// What may be leapt over, against brute force.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "pipeline/threads/work_team.h"
#include "tests/ui/support/synthetic_volume.h"
#include "ui/bricks/brick_distances.h"
#include "ui/bricks/brick_grid.h"
#include "ui/ray_caster/ray_geometry.h"
#include "ui/ray_caster/step_table.h"
#include "ui/view/camera.h"

namespace octascope::tests {
namespace {

constexpr pipeline::VolumeGeometry geometry{100, 61, 33, 10, 10, 10};

class BrickDistances : public testing::Test {
protected:
  struct Place {
    int z, a, b;
  };

  void SetUp() override {
    pipeline::Volume volume = uniform_volume(geometry, 0);
    // Cells that touch a speck: along depth the bin's and the one above, else the voxel's and the
    // next.
    for (const Place& voxel : {Place{90, 20, 3}, Place{7, 55, 30}, Place{50, 33, 17}}) {
      volume.b_scan(voxel.b)[static_cast<std::size_t>(voxel.a * 100 + voxel.z)] = 200;
      for (int cell = 0; cell < 8; ++cell)
        specks_.push_back({(voxel.z - (cell & 1)) >> pipeline::brick_depth_shift,
                           (voxel.a + (cell >> 1 & 1)) >> pipeline::brick_a_shift,
                           (voxel.b + (cell >> 2)) >> pipeline::brick_b_shift});
    }
    pipeline::Occupancy occupancy{geometry, 0};
    occupancy.update(volume);
    ui::ViewState view;
    const auto transfer = std::make_unique<ui::TransferTable>();
    ui::make_window_table(view, *transfer);
    const auto levels = std::make_unique<ui::VisibleLevels>();
    ui::find_visible_levels(*transfer, *levels);
    grid_.update(occupancy, *levels, ui::Visibility::range);
  }

  // `nearest` says the least distance to a speck that is so far away along the axes, or a large
  // one.
  template <class Nearest> void expect(const std::uint16_t* numbers, int most, Nearest nearest) {
    const pipeline::BrickCounts n = grid_.counts();
    for (int b = 0; b < n.b; ++b)
      for (int a = 0; a < n.a; ++a)
        for (int z = 0; z < n.depth; ++z) {
          int least = most;
          bool occupied = false;
          for (const Place& speck : specks_) {
            least = std::min(least, nearest(speck.z - z, speck.a - a, speck.b - b));
            occupied |= speck.z == z && speck.a == a && speck.b == b;
          }
          const auto found = numbers[(b * n.a + a) * n.depth + z];
          EXPECT_EQ(found & 0xFF, least) << z << ' ' << a << ' ' << b;
          EXPECT_EQ(found >> 8, occupied ? 200 : 0) << z << ' ' << a << ' ' << b;
        }
  }

  std::vector<Place> specks_;
  ui::BrickGrid grid_;
};

TEST_F(BrickDistances, around_are_to_the_nearest_brick_that_is_not_empty) {
  ui::WorkTeam two{1, pipeline::ThreadSetup{}};
  for (ui::WorkTeam* const team : {static_cast<ui::WorkTeam*>(nullptr), &two}) {
    ui::DistancesAround distances;
    distances.measure(grid_, team);
    expect(distances.data(), ui::DistancesAround::most, [](int z, int a, int b) {
      return std::max({std::abs(z), std::abs(a), std::abs(b)});
    });
  }
}

TEST_F(BrickDistances, ahead_are_to_the_nearest_brick_in_the_octant_that_is_not_empty) {
  ui::DistancesAhead distances;
  distances.measure(grid_, 0xFF);
  for (int octant = 0; octant < ui::DistancesAhead::octants; ++octant) {
    SCOPED_TRACE(octant);
    expect(distances.data() + static_cast<std::size_t>(octant) * grid_.counts().all(),
           ui::DistancesAhead::most, [octant](int z, int a, int b) {
             const int ahead_z = (octant & 1) != 0 ? z : -z;
             const int ahead_a = (octant & 2) != 0 ? a : -a;
             const int ahead_b = (octant & 4) != 0 ? b : -b;
             return std::min({ahead_z, ahead_a, ahead_b}) < 0
                        ? ui::DistancesAhead::most
                        : std::max({ahead_z, ahead_a, ahead_b});
           });
  }
}

TEST_F(BrickDistances, ahead_are_measured_when_wanted_and_anew_when_the_grid_has_changed) {
  ui::DistancesAhead wanted, all;
  all.measure(grid_, 0xFF);
  const std::size_t bricks = grid_.counts().all();
  const auto same = [&](std::size_t octant) {
    return std::equal(all.data() + octant * bricks, all.data() + (octant + 1) * bricks,
                      wanted.data() + octant * bricks);
  };
  wanted.measure(grid_, 1U << 5);
  EXPECT_TRUE(same(5));
  EXPECT_FALSE(same(2));
  wanted.measure(grid_, 1U << 2);
  EXPECT_TRUE(same(2));

  pipeline::Occupancy empty{geometry, 0};
  empty.update(uniform_volume(geometry, 0));
  const auto nothing = std::make_unique<ui::VisibleLevels>();
  grid_.update(empty, *nothing, ui::Visibility::everything);
  wanted.forget();
  wanted.measure(grid_, 1U << 2);
  EXPECT_EQ(wanted.data()[2 * bricks] & 0xFF, 0) << "nothing may be leapt over";
}

// Every ray of a picture lies in an octant that is measured for it.
TEST(OctantsOfRays, hold_the_rays_of_any_view) {
  const pipeline::VolumeGeometry g{512, 300, 80, 3.6, 20, 75};
  std::mt19937 random{7};
  std::uniform_real_distribution<float> yaw{-180, 180}, tilt{-90, 90}, distance{0.3F, 4},
      place{-1, 1};
  for (int i = 0; i < 2000; ++i) {
    ui::ViewState view;
    view.yaw_deg = i % 5 == 0 ? 0 : yaw(random); // along an axis, too
    view.tilt_deg = i % 7 == 0 ? 90 : tilt(random);
    view.distance = distance(random);
    const ui::Camera camera = ui::make_camera(view, ui::box_extents_mm(g), 16.0F / 9);
    const unsigned octants = ui::octants_of_rays(g, camera);
    const ui::RayGeometry rays = ui::ray_geometry(g, camera);
    for (int ray = 0; ray < 20; ++ray) {
      const glm::vec3 d = rays.forward +
                          place(random) * camera.tan_half_height * camera.aspect * rays.right +
                          place(random) * camera.tan_half_height * rays.up;
      unsigned octant = 0;
      for (int axis = 0; axis < 3; ++axis)
        octant |= d[axis] >= 0 ? 1U << axis : 0U;
      EXPECT_NE(octants & 1U << octant, 0U) << i;
    }
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
