// Pictures by GL of every technique that composites, on the screen, against closed forms.
#include <algorithm>
#include <array>
#include <optional>
#include <string>

#include "pipeline/volume/level_scale.h"
#include "tests/support/fails_with.h"
#include "tests/ui/support/gl_test.h"
#include "tests/ui/support/synthetic_volume.h"
#include "ui/scene/volume_painter.h"
#include "ui/view/camera.h"

namespace octascope::tests {
namespace {

constexpr pipeline::VolumeGeometry cube{32, 32, 32, 50, 50, 50};
constexpr int size = 200;

ui::ViewState plain_view() {
  ui::ViewState view;
  view.yaw_deg = 0;
  view.tilt_deg = 0;
  view.window_offset_db = 0;
  view.window_size_db = 40;
  view.opacity = 1;
  return view;
}

// Draws volumes alone onto white, so that a pixel is grey·α + 255·(1 − α).
class VolumePictureTest : public GlTest, public testing::WithParamInterface<ui::Technique> {
protected:
  void SetUp() override {
    open(size, size);
    if (IsSkipped())
      return;
    auto made = ui::VolumePainter::create();
    ASSERT_TRUE(made) << made.error().message;
    painter_.emplace(std::move(*made));
  }
  void TearDown() override { painter_.reset(); }

  void upload(const pipeline::Volume& volume) {
    const auto shown = painter_->show(volume);
    ASSERT_TRUE(shown) << shown.error().message;
  }

  void draw(ui::ViewState view, int steps = 256) {
    view.technique = GetParam();
    const ui::Camera camera =
        ui::make_camera(view, ui::box_extents_mm(painter_->texture().geometry()), 1);
    const auto updated = painter_->update(ui::StereoEye::left, view, camera,
                                          {1, steps, ui::RayBackend::shader}, {0, 0, size, size});
    ASSERT_TRUE(updated) << updated.error().message;
    glViewport(0, 0, size, size);
    glClearColor(1, 1, 1, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    painter_->composite(ui::StereoEye::left, {0, 0, size, size}, size);
  }

  // x from the left, y from the top.
  static int pixel(int x, int y) {
    std::array<std::uint8_t, 4> rgba{};
    glReadPixels(x, size - 1 - y, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
    EXPECT_EQ(rgba[0], rgba[1]);
    EXPECT_EQ(rgba[0], rgba[2]);
    return rgba[0];
  }

  std::optional<ui::VolumePainter> painter_;
};

INSTANTIATE_TEST_SUITE_P(Techniques, VolumePictureTest,
                         testing::Values(ui::Technique::slices, ui::Technique::planes,
                                         ui::Technique::rays),
                         [](const auto& each) { return std::string{ui::to_string(each.param)}; });

// Half the cube is white, half dark grey; both opaque: only the near one is seen.
TEST_P(VolumePictureTest, the_near_slab_hides_the_far_one_from_both_sides) {
  pipeline::Volume volume = uniform_volume(cube, 100);
  for (int b = 0; b < 16; ++b)
    std::ranges::fill(volume.b_scan(b), std::uint8_t{200});
  upload(volume);
  ui::ViewState view = plain_view();
  draw(view); // the eye is on the side of the last B-scan: grey (−40 + 50) / 40
  EXPECT_NEAR(pixel(size / 2, size / 2), 255 * 0.25, 2);
  view.yaw_deg = 180;
  draw(view);
  EXPECT_NEAR(pixel(size / 2, size / 2), 255, 1);
}

// Opaque and bright at the first A-scans, the first depths or the first B-scans; the rest empty.
TEST_P(VolumePictureTest, nothing_is_mirrored) {
  const auto marked = [](auto&& is_marked) {
    pipeline::Volume volume = uniform_volume(cube, 0);
    for (int b = 0; b < 32; ++b)
      for (int a = 0; a < 32; ++a)
        for (int z = 0; z < 32; ++z)
          if (is_marked(z, a, b))
            volume.b_scan(b)[static_cast<std::size_t>(a * 32 + z)] = 90; // dark on white
    return volume;
  };
  const auto dark = [&](int x, int y) { return pixel(x, y) < 128; };
  constexpr int mid = size / 2;
  constexpr int off = size / 8;
  ui::ViewState view = plain_view();

  upload(marked([](int, int a, int) { return a < 12; }));
  draw(view);
  EXPECT_TRUE(dark(mid - off, mid)) << "A-scan 0 is at the left";
  EXPECT_FALSE(dark(mid + off, mid));
  upload(marked([](int z, int, int) { return z < 12; }));
  draw(view);
  EXPECT_TRUE(dark(mid, mid - off)) << "depth 0 is at the top";
  EXPECT_FALSE(dark(mid, mid + off));
  upload(marked([](int, int, int b) { return b < 12; }));
  view.tilt_deg = 89;
  draw(view);
  EXPECT_TRUE(dark(mid, mid - off)) << "from above, B-scan 0 is at the top, as in the en face";
  EXPECT_FALSE(dark(mid, mid + off));
  view.tilt_deg = 0;
  view.yaw_deg = 90; // the eye is on the side of the last A-scan
  draw(view);
  EXPECT_TRUE(dark(mid + off, mid)) << "the far B-scans of yaw 0 are at the right";
  EXPECT_FALSE(dark(mid - off, mid));
}

// Silhouette of an opaque box against the matrices.
TEST_P(VolumePictureTest, the_box_has_its_physical_aspect) {
  const pipeline::VolumeGeometry flat{512, 100, 50, 2, 30, 20}; // 1.024 × 3 × 1 mm
  upload(uniform_volume(flat, 160));                            // grey 1: white …
  ui::ViewState view = plain_view();
  view.window_size_db = 80; // … now 0.5
  view.distance = 5;
  draw(view);
  const ui::Camera camera = ui::make_camera(view, ui::box_extents_mm(flat), 1);
  const glm::vec4 corner = camera.view_projection * glm::vec4{1.5F, 0.512F, 0.5F, 1};
  const int right = static_cast<int>((1 + corner.x / corner.w) * size / 2);
  const int top = static_cast<int>((1 - corner.y / corner.w) * size / 2);
  EXPECT_LT(pixel(right - 3, size / 2), 200);
  EXPECT_EQ(pixel(right + 3, size / 2), 255);
  EXPECT_LT(pixel(size / 2, top + 3), 200);
  EXPECT_EQ(pixel(size / 2, top - 3), 255);
}

TEST_P(VolumePictureTest, a_change_of_the_window_needs_no_new_volume) {
  upload(uniform_volume(cube, 130)); // 25 dB
  ui::ViewState view = plain_view();
  draw(view);
  EXPECT_NEAR(pixel(size / 2, size / 2), 255 * 25.0 / 40, 2);
  view.window_size_db = 100;
  draw(view);
  EXPECT_NEAR(pixel(size / 2, size / 2), 255 * 25.0 / 100, 2);
  view.window_offset_db = 30;
  draw(view);
  EXPECT_EQ(pixel(size / 2, size / 2), 255) << "below the window all is clear";
}

TEST_P(VolumePictureTest, refuses_volumes_that_do_not_fit_and_keeps_the_last) {
  upload(uniform_volume(cube, 130));
  pipeline::Volume torn = uniform_volume(cube, 0);
  torn.levels.pop_back();
  EXPECT_THAT(painter_->show(torn), FailsWith(hal::ErrorCode::bad_data));

  GLint largest = 0;
  glGetIntegerv(GL_MAX_3D_TEXTURE_SIZE, &largest);
  EXPECT_THAT(
      painter_->show(pipeline::Volume{pipeline::VolumeGeometry{largest + 1, 1, 1, 1, 1, 1}}),
      FailsWith(hal::ErrorCode::unsupported, std::to_string(largest)));

  draw(plain_view());
  EXPECT_NEAR(pixel(size / 2, size / 2), 255 * 25.0 / 40, 2);
}

} // namespace
} // namespace octascope::tests
