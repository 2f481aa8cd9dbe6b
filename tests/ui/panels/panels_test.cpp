#include <cmath>
#include <random>

#include "pipeline/volume/level_scale.h"
#include "tests/support/fails_with.h"
#include "tests/ui/support/gl_test.h"
#include "tests/ui/support/synthetic_volume.h"
#include "ui/gl/program.h"
#include "ui/panels/b_scan_panel.h"
#include "ui/panels/en_face_panel.h"
#include "ui/panels/projection.h"
#include "ui/panels/tissue_map.h"
#include "ui/volume/volume_texture.h"

namespace octascope::tests {
namespace {

using pipeline::BScanState;

constexpr int width = 640;
constexpr int height = 360;

std::array<std::uint8_t, 4> pixel(int x, int y) {
  std::array<std::uint8_t, 4> rgba{};
  glReadPixels(x, height - 1 - y, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
  return rgba;
}

class PanelTest : public GlTest {
protected:
  // The whole of a volume's B-scan, or of what is across all of them.
  void draw_b_scan(const pipeline::Volume& volume, const ui::ViewState& view, const ui::Rect& rect,
                   ui::ScanDirection direction = ui::ScanDirection::fast,
                   const ui::Crop& crop = {}) {
    ui::VolumeTexture texture;
    ASSERT_TRUE(texture.upload(volume));
    ui::StateTexture states;
    states.upload(volume);
    const auto panel = ui::BScanPanel::create();
    ASSERT_TRUE(panel) << panel.error().message;
    panel->draw(texture, states, direction, view, crop, rect, height);
  }
  static bool is_coloured(int x, int y) { return pixel(x, y)[0] > pixel(x, y)[2] + 20; }
};

ui::TissueMap tissue_of(const pipeline::Volume& volume) {
  pipeline::Occupancy occupancy{volume.geometry, pipeline::blank_depth_bins};
  occupancy.update(volume);
  ui::TissueMap tissue;
  tissue.update(occupancy, volume.b_scan_states);
  return tissue;
}

// Noise of a fixed seed: levels 60 to 79.
void add_noise(pipeline::Volume& volume) {
  std::minstd_rand random{7};
  for (std::uint8_t& level : volume.levels)
    level = static_cast<std::uint8_t>(60 + random() % 20);
}

// Tissue of that level between two depths, for A-scans and B-scans from one to before another.
void fill(pipeline::Volume& volume, std::array<int, 2> depths, std::array<int, 2> a,
          std::array<int, 2> b, std::uint8_t level) {
  for (int y = b[0]; y < b[1]; ++y)
    for (int x = a[0]; x < a[1]; ++x)
      std::fill_n(volume.b_scan(y).begin() + x * volume.geometry.depths + depths[0],
                  depths[1] - depths[0], level);
}

TEST_F(PanelTest, a_broken_shader_is_named_with_the_compilers_words) {
  EXPECT_THAT(ui::gl::Program::build("broken", "void main() { gl_Position = vec4(0); }",
                                     "void main() { nonsense; }"),
              FailsSaying("broken.frag", "nonsense"));
}

// Every count there is, one pixel each: formula (1) to the rounding of 8 bits.
TEST_F(PanelTest, b_scan_is_windowed_exactly) {
  const pipeline::VolumeGeometry geometry{256, 8, 3, 1, 1, 1};
  pipeline::Volume volume = uniform_volume(geometry, 0);
  for (std::size_t i = 0; i < geometry.b_scan_voxels(); ++i)
    volume.b_scan(1)[i] = static_cast<std::uint8_t>(i % 256); // count = depth
  ui::ViewState view;
  view.b_scan = 1;
  for (const auto& [lower, extent] :
       {std::pair{8.0, 36.0}, std::pair{-40.0, 127.5}, std::pair{20.0, 1.0}}) {
    view.window_offset_db = static_cast<float>(lower);
    view.window_size_db = static_cast<float>(extent);
    draw_b_scan(volume, view, {0, 0, 8, 256});
    for (int z = 0; z < 256; ++z) {
      const double db = -40 + 0.5 * z;
      const double opacity = std::clamp((db - lower) / extent, 0.0, 1.0);
      EXPECT_NEAR(pixel(5, z)[0], 255 * opacity, most_rounded_off()) << "level " << db << " dB";
    }
  }
}

TEST_F(PanelTest, b_scan_has_a_scan_0_left_and_depth_0_on_top) {
  const pipeline::VolumeGeometry geometry{32, 32, 4, 1, 1, 1};
  pipeline::Volume volume = uniform_volume(geometry, 0);
  volume.b_scan(2)[3 * 32 + 5] = 255; // A-scan 3, depth 5
  ui::ViewState view;
  view.b_scan = 2;
  draw_b_scan(volume, view, {100, 50, 32, 32});
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 32; ++x)
      EXPECT_EQ(pixel(100 + x, 50 + y)[0], x == 3 && y == 5 ? 255 : 0) << x << ", " << y;
}

TEST_F(PanelTest, a_missing_b_scan_is_hatched_with_colour) {
  pipeline::Volume volume = uniform_volume({32, 32, 4, 1, 1, 1}, 200);
  volume.b_scan_states[1] = BScanState::missing;
  ui::ViewState view;
  view.b_scan = 1;
  draw_b_scan(volume, view, {0, 0, 64, 64});
  int coloured = 0;
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x)
      coloured += is_coloured(x, y) ? 1 : 0;
  EXPECT_NEAR(coloured, 64 * 64 / 2, 64 * 64 / 8) << "half of it striped";
}

TEST_F(PanelTest, the_crossed_b_scan_has_b_scan_0_left_and_depth_0_on_top) {
  pipeline::Volume volume = uniform_volume({32, 16, 32, 1, 1, 1}, 0);
  volume.b_scan(6)[11 * 32 + 5] = 255; // A-scan 11, depth 5
  ui::ViewState view;
  view.a_scan = 11;
  draw_b_scan(volume, view, {100, 50, 32, 32}, ui::ScanDirection::slow);
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 32; ++x)
      EXPECT_EQ(pixel(100 + x, 50 + y)[0], x == 6 && y == 5 ? 255 : 0) << x << ", " << y;
}

TEST_F(PanelTest, the_crossed_b_scan_hatches_missing_b_scans_and_mixes_none_with_its_neighbours) {
  pipeline::Volume volume = uniform_volume({32, 16, 8, 1, 1, 1}, 200);
  volume.b_scan_states[3] = BScanState::missing;
  std::ranges::fill(volume.b_scan(3), std::uint8_t{0});
  volume.b_scan_states[6] = BScanState::saturated;
  draw_b_scan(volume, {}, {0, 0, 80, 80}, ui::ScanDirection::slow); // ten pixels a B-scan
  const auto striped = [&](int b) {
    int count = 0;
    for (int y = 10; y < 80; ++y)
      count += is_coloured(10 * b + 5, y) ? 1 : 0;
    return count;
  };
  EXPECT_GT(striped(3), 20);
  for (const int b : {2, 4, 6})
    EXPECT_EQ(striped(b), 0) << b;
  const auto beside = pixel(29, 40);
  EXPECT_EQ(beside, pixel(25, 40)) << "as bright beside the missing one as in its own middle";
  EXPECT_TRUE(is_coloured(65, 1)) << "marked at the upper border";
  EXPECT_FALSE(is_coloured(55, 1));
}

// What the crop leaves fills the panel: the voxel of its corner is there.
TEST_F(PanelTest, a_crop_shows_its_part_of_the_b_scan) {
  pipeline::Volume volume = uniform_volume({32, 32, 4, 1, 1, 1}, 0);
  volume.b_scan(2)[16 * 32 + 8] = 255; // A-scan 16, depth 8
  ui::ViewState view;
  view.b_scan = 2;
  draw_b_scan(volume, view, {0, 0, 16, 16}, ui::ScanDirection::fast,
              {.depth = {0.25F, 0.75F}, .a = {0.5F, 1}});
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 16; ++x)
      EXPECT_EQ(pixel(x, y)[0], x == 0 && y == 0 ? 255 : 0) << x << ", " << y;
}

TEST_F(PanelTest, en_face_has_b_scan_0_on_top_and_shows_missing_and_saturated_ones) {
  const pipeline::VolumeGeometry geometry{64, 40, 20, 1, 1, 1};
  pipeline::Volume volume = uniform_volume(geometry, 10);
  // One bright 8 × 4 corner at the first A-scans of the first B-scans.
  for (int b = 0; b < 4; ++b)
    std::fill_n(volume.b_scan(b).begin(), 8 * 64, std::uint8_t{210});
  volume.b_scan_states[10] = BScanState::missing;
  volume.b_scan_states[15] = BScanState::saturated;
  auto panel = ui::EnFacePanel::create();
  ASSERT_TRUE(panel) << panel.error().message;
  panel->show(volume, tissue_of(volume));
  ui::StateTexture states;
  states.upload(volume);
  panel->draw(states, {}, {0, 0, 200, 100}, height); // five pixels an A-scan and a B-scan
  EXPECT_GT(pixel(10, 5)[0], 250) << "first A-scan, first B-scan";
  EXPECT_LT(pixel(190, 5)[0], 5);
  EXPECT_LT(pixel(10, 95)[0], 5);
  const auto is_striped = [&](int b) {
    for (int x = 0; x < 190; ++x)
      if (pixel(x, 5 * b + 2)[0] > pixel(x, 5 * b + 2)[2] + 20)
        return true;
    return false;
  };
  EXPECT_TRUE(is_striped(10));
  EXPECT_FALSE(is_striped(9));
  EXPECT_FALSE(is_striped(11));
  EXPECT_GT(pixel(198, 5 * 15 + 2)[0], 200) << "marked at the right border";
  EXPECT_LT(pixel(198, 5 * 14 + 2)[0], 10);
  EXPECT_FALSE(is_striped(15));
}

// A front layer that curves, a gap, and something behind it in a part: what is behind the gap shows,
// and beside it, where there is none, what lies just below the surface.
TEST(Projection, shows_what_lies_behind_a_gap_and_else_what_lies_below_the_surface) {
  const pipeline::VolumeGeometry geometry{400, 96, 24, 5, 20, 80}; // 2 mm deep
  pipeline::Volume volume = uniform_volume(geometry, 0);
  add_noise(volume);
  for (int b = 0; b < 24; ++b)
    for (int a = 0; a < 96; ++a) {
      const int surface = 40 + a / 2;
      fill(volume, {surface, surface + 4}, {a, a + 1}, {b, b + 1}, 240); // the surface's glare
      fill(volume, {surface + 4, surface + 60}, {a, a + 1}, {b, b + 1}, a < 48 ? 130 : 160);
    }
  fill(volume, {280, 340}, {0, 32}, {0, 24}, 200);
  std::vector<std::uint8_t> levels(96 * 24);
  ui::project_slab(volume, tissue_of(volume), levels);
  for (int b = 2; b < 22; ++b) {
    const auto at = [&](int a) { return levels[static_cast<std::size_t>(b * 96 + a)]; };
    for (const int a : {4, 16, 26})
      EXPECT_EQ(at(a), 200) << "behind the gap, " << a;
    EXPECT_EQ(at(40), 130) << "below the surface";
    for (const int a : {56, 70, 88})
      EXPECT_EQ(at(a), 160) << "the surface's own glare shows nowhere, " << a;
  }
}

// Beyond an edge that runs obliquely over the bricks, what is found behind the gap and what below the
// surface are mixed: else the bricks' own outline shows.
TEST(Projection, has_no_stairs_along_an_edge) {
  const pipeline::VolumeGeometry geometry{400, 96, 48, 5, 20, 80};
  pipeline::Volume volume = uniform_volume(geometry, 0);
  add_noise(volume);
  for (int b = 0; b < 48; ++b) {
    fill(volume, {40, 160}, {0, 96}, {b, b + 1}, 130);
    fill(volume, {280, 340}, {0, 24 + b}, {b, b + 1}, 210); // behind a gap
  }
  std::vector<std::uint8_t> levels(96 * 48);
  ui::project_slab(volume, tissue_of(volume), levels);
  for (int b = 4; b < 44; ++b) {
    const auto at = [&](int a) { return levels[static_cast<std::size_t>(b * 96 + a)]; };
    EXPECT_EQ(at(24 + b - 4), 210);
    EXPECT_EQ(at(24 + b + 12), 130);
    for (int a = 24 + b + 1; a < 24 + b + 12; ++a)
      EXPECT_LE(at(a) - at(a - 1), 30) << "not at once from noise to the surface's level, " << b;
  }
}

// As a shaft's reflection: a few voxels deep, on a slope.
TEST(Projection, finds_what_is_thin_and_slopes_behind_a_gap) {
  const pipeline::VolumeGeometry geometry{400, 96, 24, 9, 32, 115};
  pipeline::Volume volume = uniform_volume(geometry, 0);
  add_noise(volume);
  for (int b = 0; b < 24; ++b)
    for (int a = 0; a < 96; ++a) {
      fill(volume, {40, 90}, {a, a + 1}, {b, b + 1}, 130);
      const int top = 300 - 3 * a / 2;
      fill(volume, {top, top + 3}, {a, a + 1}, {b, b + 1}, 220);
    }
  std::vector<std::uint8_t> levels(96 * 24);
  ui::project_slab(volume, tissue_of(volume), levels);
  for (int b = 2; b < 22; ++b)
    for (int a = 4; a < 92; ++a)
      EXPECT_EQ(levels[static_cast<std::size_t>(b * 96 + a)], 220) << b << ' ' << a;
}

// An instrument, and its shadow below it.
TEST(Projection, shows_a_surface_that_has_nothing_below_it) {
  const pipeline::VolumeGeometry geometry{400, 96, 24, 9, 32, 115};
  pipeline::Volume volume = uniform_volume(geometry, 0);
  add_noise(volume);
  fill(volume, {120, 240}, {0, 96}, {0, 24}, 130);
  for (int b = 8; b < 16; ++b)
    for (int a = 0; a < 96; ++a) {
      for (int z = 120; z < 240; ++z)
        volume.b_scan(b)[static_cast<std::size_t>(a * 400 + z)] = 70;
      fill(volume, {100, 106}, {a, a + 1}, {b, b + 1}, 220);
    }
  std::vector<std::uint8_t> levels(96 * 24);
  ui::project_slab(volume, tissue_of(volume), levels);
  for (int a = 8; a < 88; ++a) {
    EXPECT_EQ(levels[static_cast<std::size_t>(12 * 96 + a)], 220) << a;
    EXPECT_EQ(levels[static_cast<std::size_t>(2 * 96 + a)], 130) << a;
  }
}

TEST(Projection, contrast_ignores_missing_b_scans_and_outliers) {
  const pipeline::VolumeGeometry geometry{100, 100, 4, 1, 1, 1};
  pipeline::Volume volume = uniform_volume(geometry, 0);
  volume.b_scan_states[3] = BScanState::missing;
  std::vector<std::uint8_t> levels(400, 0);
  for (std::size_t i = 0; i < 300; ++i)
    levels[i] = static_cast<std::uint8_t>(100 + i / 6);
  levels[0] = 255; // one A-scan of specular reflection
  ui::stretch_contrast(volume, levels);
  EXPECT_EQ(levels[0], 255);
  EXPECT_EQ(levels[399], 0);
  EXPECT_LT(levels[5], 6);
  EXPECT_GT(levels[295], 249);
  EXPECT_NEAR(levels[150], 127, 4);
}

// ---- Where the tissue is.

TEST(TissueMap, leaves_out_the_empty_half_and_keeps_what_is_small_in_it) {
  const pipeline::VolumeGeometry geometry{512, 96, 40, 4, 20, 50};
  pipeline::Volume volume = uniform_volume(geometry, 0);
  add_noise(volume);
  EXPECT_EQ(tissue_of(volume).extents(), ui::Crop{}) << "of noise alone, everything";
  fill(volume, {280, 420}, {0, 96}, {20, 40}, 150);
  const ui::Crop half = tissue_of(volume).extents();
  EXPECT_EQ(half.depth, (ui::Section{8.0F / 16, 14.0F / 16}));
  EXPECT_EQ(half.a, ui::Section{});
  EXPECT_EQ(half.b, (ui::Section{7.0F / 16, 1}));
  fill(volume, {100, 130}, {40, 48}, {22, 30}, 200); // an instrument above it, 0.2 x 0.4 mm
  EXPECT_EQ(tissue_of(volume).extents().depth, (ui::Section{2.0F / 16, 14.0F / 16}));
  volume.b_scan_states[2] = BScanState::missing;
  EXPECT_EQ(tissue_of(volume).extents().b.from, 0) << "a missing B-scan is hatched, not left out";
}

TEST(SteadyCrop, grows_at_once_and_shrinks_only_after_twenty_volumes) {
  const auto deep = [](float from, float to) { return ui::Crop{.depth = {from / 16, to / 16}}; };
  ui::SteadyCrop crop;
  EXPECT_EQ(crop.current(), ui::Crop{}) << "before any volume, everything";
  crop.follow(deep(4, 12));
  EXPECT_EQ(crop.current(), deep(4, 12)) << "begins with the first";
  crop.follow(deep(2, 10));
  EXPECT_EQ(crop.current(), deep(2, 12));
  for (int i = 0; i < 19; ++i)
    crop.follow(deep(5, 10));
  EXPECT_EQ(crop.current(), deep(2, 12));
  crop.follow(deep(4, 10));
  EXPECT_EQ(crop.current(), deep(4, 10)) << "as far as any of the twenty needed";
  for (int i = 0; i < 200; ++i)
    crop.follow(deep(i % 2 == 0 ? 5 : 4, 10));
  EXPECT_EQ(crop.current(), deep(4, 10)) << "what flickers does not move the picture";
}

} // namespace
} // namespace octascope::tests
