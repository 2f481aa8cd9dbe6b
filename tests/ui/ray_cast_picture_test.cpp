// The processor's picture of a volume and the plane stack's are the same picture.
#include <array>
#include <optional>

#include "pipeline/png_image.h"
#include "tests/ui/support/gl_test.h"
#include "tests/ui/support/picture_file.h"
#include "tests/ui/support/scene.h"
#include "tests/ui/support/synthetic_volume.h"
#include "ui/ray_caster/ray_cast_picture.h"

namespace octascope::tests {
namespace {

constexpr int width = 320;
constexpr int height = 200;
constexpr std::size_t middle = width * height / 2 + width / 2;
constexpr ui::Rect rect{0, 0, width, height};
constexpr ui::DrawQuality fine{1, 1024};

class RayCastPictureTest : public GlTest {
protected:
  void SetUp() override {
    open(width, height);
    if (IsSkipped())
      return;
    auto planes = ui::VolumePicture::create();
    ASSERT_TRUE(planes) << planes.error().message;
    planes_.emplace(std::move(*planes));
    auto rays = ui::RayCastPicture::create(1, {});
    ASSERT_TRUE(rays) << rays.error().message;
    rays_.emplace(std::move(*rays));
  }
  void TearDown() override {
    planes_.reset();
    rays_.reset();
    texture_ = {};
  }

  void show(const pipeline::Volume& volume) {
    ASSERT_TRUE(texture_.upload(volume));
    ASSERT_TRUE(rays_->show(volume));
    ++uploads_;
  }

  template <class Picture> static pipeline::Image read(const Picture& picture, float ground) {
    glViewport(0, 0, width, height);
    glClearColor(ground, ground, ground, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    picture.composite(rect, height);
    pipeline::Image image{width, height, 3};
    std::vector<std::uint8_t> rgba(4 * width * height);
    glReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
    for (std::size_t i = 0; i < rgba.size() / 4; ++i)
      for (std::size_t c = 0; c < 3; ++c)
        image.pixels[3 * i + c] = rgba[4 * i + c];
    return image;
  }

  // Mean difference on black and on white: of colour, and of colour and opacity together.
  void expect_same(const ui::ViewState& view, const std::string& what) {
    ASSERT_TRUE(planes_->update(texture_, uploads_, view, fine, rect));
    ASSERT_TRUE(rays_->update(uploads_, view, ui::RayMode::composite, fine, rect));
    for (const float ground : {0.0F, 1.0F}) {
      const pipeline::Image planes = read(*planes_, ground);
      const pipeline::Image rays = read(*rays_, ground);
      EXPECT_LE(compare(planes, rays).mean, 2) << what << " on " << ground;
    }
  }

  std::optional<ui::VolumePicture> planes_;
  std::optional<ui::RayCastPicture> rays_;
  ui::VolumeTexture texture_;
  std::uint64_t uploads_ = 0;
};

ui::ViewState fine_view(float yaw_deg, float tilt_deg, float distance, float opacity) {
  ui::ViewState view;
  view.yaw_deg = yaw_deg;
  view.tilt_deg = tilt_deg;
  view.distance = distance;
  view.opacity = opacity;
  return view;
}

TEST_F(RayCastPictureTest, is_the_plane_stacks_at_fine_spacing) {
  pipeline::Volume volume = tissue_volume(small_geometry);
  for (const bool incomplete : {false, true}) {
    if (incomplete)
      mark_incomplete(volume);
    show(volume);
    for (const float opacity : {0.5F, 0.03F}) {
      const std::string what =
          std::string{incomplete ? "incomplete" : "whole"} + ", " + std::to_string(opacity);
      expect_same(fine_view(35, 35, 2.4F, opacity), "oblique, " + what);
      expect_same(fine_view(-130, -20, 1.2F, opacity), "near from below, " + what);
      expect_same(fine_view(0, 89, 3.1F, opacity), "from above, " + what);
      expect_same(fine_view(80, 10, 0.7F, opacity), "inside, " + what);
    }
  }
}

TEST_F(RayCastPictureTest, is_drawn_again_only_when_something_changed) {
  show(tissue_volume(small_geometry));
  ui::ViewState view = fine_view(35, 35, 2.4F, 0.5F);
  ASSERT_TRUE(rays_->update(uploads_, view, ui::RayMode::composite, {}, rect));
  const std::uint32_t kept = rays_->image().rgba[middle];
  show(uniform_volume(small_geometry, 0));
  --uploads_; // as if the same volume were shown
  ASSERT_TRUE(rays_->update(uploads_, view, ui::RayMode::composite, {}, rect));
  EXPECT_EQ(rays_->image().rgba[middle], kept);
  view.window_offset_db += 1;
  ASSERT_TRUE(rays_->update(uploads_, view, ui::RayMode::composite, {}, rect));
  EXPECT_EQ(rays_->image().rgba[middle], 0U) << "the volume is empty now";
  EXPECT_NE(kept, 0U);
}

} // namespace
} // namespace octascope::tests
