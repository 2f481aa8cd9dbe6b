#include <cmath>

#include "pipeline/volume/level_scale.h"
#include "tests/support/fails_with.h"
#include "tests/ui/support/gl_test.h"
#include "tests/ui/support/synthetic_volume.h"
#include "ui/gl/program.h"
#include "ui/panels/b_scan_panel.h"
#include "ui/panels/en_face_panel.h"
#include "ui/panels/projection.h"
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

class PanelTest : public GlTest {};

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
  ui::VolumeTexture texture;
  ASSERT_TRUE(texture.upload(volume));
  const auto panel = ui::BScanPanel::create();
  ASSERT_TRUE(panel) << panel.error().message;
  ui::ViewState view;
  view.b_scan = 1;
  for (const auto& [lower, extent] :
       {std::pair{8.0, 36.0}, std::pair{-40.0, 127.5}, std::pair{20.0, 1.0}}) {
    view.window_offset_db = static_cast<float>(lower);
    view.window_size_db = static_cast<float>(extent);
    panel->draw(texture, BScanState::good, view, {0, 0, 8, 256}, height);
    for (int z = 0; z < 256; ++z) {
      const double db = -40 + 0.5 * z;
      const double opacity = std::clamp((db - lower) / extent, 0.0, 1.0);
      EXPECT_NEAR(pixel(5, z)[0], 255 * opacity, 0.51) << "level " << db << " dB";
    }
  }
}

TEST_F(PanelTest, b_scan_has_a_scan_0_left_and_depth_0_on_top) {
  const pipeline::VolumeGeometry geometry{32, 32, 4, 1, 1, 1};
  pipeline::Volume volume = uniform_volume(geometry, 0);
  volume.b_scan(2)[3 * 32 + 5] = 255; // A-scan 3, depth 5
  ui::VolumeTexture texture;
  ASSERT_TRUE(texture.upload(volume));
  const auto panel = ui::BScanPanel::create();
  ASSERT_TRUE(panel);
  ui::ViewState view;
  view.b_scan = 2;
  panel->draw(texture, BScanState::good, view, {100, 50, 32, 32}, height);
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 32; ++x)
      EXPECT_EQ(pixel(100 + x, 50 + y)[0], x == 3 && y == 5 ? 255 : 0) << x << ", " << y;
}

TEST_F(PanelTest, a_missing_b_scan_is_hatched_with_colour) {
  ui::VolumeTexture texture;
  ASSERT_TRUE(texture.upload(uniform_volume({32, 32, 4, 1, 1, 1}, 200)));
  const auto panel = ui::BScanPanel::create();
  ASSERT_TRUE(panel);
  panel->draw(texture, BScanState::missing, {}, {0, 0, 64, 64}, height);
  int coloured = 0;
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x)
      coloured += pixel(x, y)[0] > pixel(x, y)[2] + 20 ? 1 : 0;
  EXPECT_NEAR(coloured, 64 * 64 / 2, 64 * 64 / 8) << "half of it striped";
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
  panel->show(volume);
  panel->draw({0, 0, 200, 100}, height); // five pixels an A-scan and a B-scan
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

TEST(Projection, sums_every_a_scan_also_beyond_one_chunk) {
  const pipeline::VolumeGeometry geometry{1000, 7, 3, 1, 1, 1};
  pipeline::Volume volume = uniform_volume(geometry, 255);
  volume.b_scan(1)[2 * 1000 + 999] = 0;
  std::vector<std::uint32_t> sums(21);
  ui::project_sum(volume, sums);
  for (std::size_t i = 0; i < sums.size(); ++i)
    EXPECT_EQ(sums[i], i == 7 + 2 ? 254'745U : 255'000U);
}

TEST(Projection, contrast_ignores_missing_b_scans_and_outliers) {
  const pipeline::VolumeGeometry geometry{100, 100, 4, 1, 1, 1};
  pipeline::Volume volume = uniform_volume(geometry, 0);
  volume.b_scan_states[3] = BScanState::missing;
  std::vector<std::uint32_t> sums(400, 0);
  for (std::size_t i = 0; i < 300; ++i)
    sums[i] = static_cast<std::uint32_t>(10'000 + 10 * i);
  sums[0] = 25'500; // one A-scan of specular reflection
  std::vector<std::uint8_t> grey(400);
  ui::stretch_contrast(volume, sums, grey);
  EXPECT_EQ(grey[0], 255);
  EXPECT_EQ(grey[399], 0);
  EXPECT_LT(grey[5], 6);
  EXPECT_GT(grey[295], 249);
  EXPECT_NEAR(grey[150], 127, 4);
}

} // namespace
} // namespace octascope::tests
