// Two eyes: where points fall, and what both see alike.
#include <cmath>
#include <memory>
#include <random>

#include <glm/geometric.hpp>

#include "tests/support/files/fresh_seed.h"
#include "tests/ui/support/picture_file.h"
#include "tests/ui/support/reference_rays.h"
#include "tests/ui/support/renderer_stage.h"
#include "ui/layout/stereo.h"

namespace octascope::tests {
namespace {

using namespace ui;

constexpr glm::vec3 extents{3, 1.8F, 3};

struct EyePair {
  Camera left;
  Camera right;
  Camera centre;

  EyePair(const ViewState& view, float aspect)
      : left{make_camera(view, extents, aspect, StereoEye::left)},
        right{make_camera(view, extents, aspect, StereoEye::right)}, centre{make_camera(
                                                                         view, extents, aspect)} {}
};

ViewState any_view(std::mt19937& random) {
  std::uniform_real_distribution<float> share{0, 1};
  ViewState view;
  view.yaw_deg = 360 * share(random) - 180;
  view.tilt_deg = 178 * share(random) - 89;
  view.distance = 1.5F + 4 * share(random);
  view.parallax_deg = 0.5F + 8 * share(random);
  return view;
}

glm::vec3 any_point(std::mt19937& random) {
  std::uniform_real_distribution<float> share{-0.5F, 0.5F};
  return extents * glm::vec3{share(random), share(random), share(random)};
}

TEST(Stereo, near_points_cross_far_points_do_not_and_none_moves_up_or_down) {
  std::mt19937 random{fresh_seed()};
  for (int i = 0; i < 1000; ++i) {
    const EyePair eyes{any_view(random), 1.4F};
    const glm::vec3 point = any_point(random);
    const glm::vec2 left = eyes.left.project(point);
    const glm::vec2 right = eyes.right.project(point);
    EXPECT_NEAR(left.y, right.y, 1e-5F);
    for (const Camera* camera : {&eyes.left, &eyes.right, &eyes.centre})
      EXPECT_LT(glm::length(camera->project({0, 0, 0})), 1e-5F) << "the volume's centre";
    const float nearer = eyes.centre.depth_of({0, 0, 0}) - eyes.centre.depth_of(point);
    if (std::abs(nearer) > 0.01F) {
      EXPECT_GT((left.x - right.x) * nearer, 0) << "crossed where it is nearer";
    }
  }
}

TEST(Stereo, the_eyes_are_as_far_apart_as_the_parallax_says) {
  ViewState view;
  view.parallax_deg = 4;
  const EyePair eyes{view, 1};
  const double angle = std::acos(glm::dot(glm::normalize(glm::dvec3{eyes.left.eye}),
                                          glm::normalize(glm::dvec3{eyes.right.eye}))) *
                       180 / 3.14159265358979;
  EXPECT_NEAR(angle, 4, 1e-3);
  EXPECT_LT(glm::dot(eyes.left.eye - eyes.right.eye, eyes.centre.right), 0);
  view.parallax_deg = 0;
  const EyePair one{view, 1};
  EXPECT_EQ(one.left.eye, one.centre.eye);
  EXPECT_EQ(one.left.view_projection, one.centre.view_projection);
}

TEST(Stereo, matrices_and_projection_agree) {
  std::mt19937 random{fresh_seed()};
  for (int i = 0; i < 300; ++i) {
    const float aspect = 1.4F;
    const EyePair eyes{any_view(random), aspect};
    for (const Camera* camera : {&eyes.left, &eyes.right, &eyes.centre}) {
      const glm::vec3 point = any_point(random);
      const glm::vec4 clip = camera->view_projection * glm::vec4{point, 1};
      const glm::vec2 at = camera->project(point);
      EXPECT_NEAR(clip.x / clip.w, 2 * at.x / aspect, 1e-4F);
      EXPECT_NEAR(clip.y / clip.w, -2 * at.y, 1e-4F);
    }
  }
}

TEST(Stereo, each_eye_has_half_of_the_frame) {
  const EyeFrame left = eye_frame(StereoMode::side_by_side, StereoEye::left, 1921, 1080);
  const EyeFrame right = eye_frame(StereoMode::side_by_side, StereoEye::right, 1921, 1080);
  EXPECT_EQ(left.target, (Rect{0, 0, 960, 1080}));
  EXPECT_EQ(right.target, (Rect{960, 0, 960, 1080}));
  EXPECT_EQ(left.place({400, 100, 201, 50}), (Rect{199, 100, 101, 50}));
  EXPECT_EQ(right.place({400, 100, 201, 50}), (Rect{960 + 199, 100, 101, 50}));
  EXPECT_EQ(eye_frame(StereoMode::top_bottom, StereoEye::right, 800, 600).target,
            (Rect{0, 300, 800, 300}));
  EXPECT_EQ(eye_frame(StereoMode::off, StereoEye::centre, 800, 600).place({1, 2, 3, 4}),
            (Rect{1, 2, 3, 4}));
  EXPECT_EQ(eyes_of(StereoMode::off).size(), 1U);
  EXPECT_EQ(eyes_of(StereoMode::top_bottom)[0], StereoEye::left);
}

// The processor's ray caster against rays in double precision, for an eye that looks past the
// middle of its picture.
TEST(Stereo, rays_are_cast_from_each_eye) {
  auto made = RayCaster::create(std::make_shared<WorkTeam>(0, pipeline::ThreadSetup{}));
  if (!made)
    GTEST_SKIP() << made.error().message;
  constexpr int width = 96;
  constexpr int height = 72;
  const auto volume = tissue_volume(small_geometry);
  pipeline::Occupancy occupancy{small_geometry, pipeline::blank_depth_bins};
  occupancy.update(volume);
  ASSERT_TRUE(made->show(volume, occupancy));
  ViewState view;
  view.parallax_deg = 10;
  const auto table = std::make_unique<TransferTable>();
  make_window_table(view, *table);
  made->set_transfer(*table);
  const glm::vec3 box = box_extents_mm(volume.geometry);
  RaySettings settings;
  settings.step_mm = glm::length(box) / 300;
  RayImage image;
  image.resize(width, height);
  for (const StereoEye eye : {StereoEye::left, StereoEye::right}) {
    const Camera camera = make_camera(view, box, 4.0F / 3, eye);
    ASSERT_TRUE(made->draw(camera, settings, image));
    const auto expected = reference_rays(volume, camera, view, settings, width, height);
    double difference = 0;
    for (std::size_t i = 0; i < expected.size(); ++i)
      difference += std::abs(static_cast<double>(image.rgba[i] & 0xFFU) - expected[i].grey);
    EXPECT_LT(difference / static_cast<double>(expected.size()), 0.5);
  }
}

// By more than a rasteriser's rounding, which depends on where in the frame a line lies.
bool differ(const std::array<std::uint8_t, 3>& a, const std::array<std::uint8_t, 3>& b) {
  constexpr int rounding = 12;
  for (std::size_t i = 0; i < a.size(); ++i)
    if (std::abs(int{a[i]} - int{b[i]}) > rounding)
      return true;
  return false;
}

class StereoPicture : public RendererTest {
protected:
  static constexpr int width = 1280;
  static constexpr int height = 720;

  void SetUp() override {
    open_renderer(width, height);
    if (IsSkipped())
      return;
    auto volume = tissue_volume(small_geometry);
    mark_incomplete(volume);
    show_scene(volume);
  }
};

// Badges, panels with their hatching and the status bar are the same for both; the volume is not.
TEST_F(StereoPicture, both_eyes_read_the_same_and_see_the_volume_differently) {
  Status status = live_status();
  status.freshness = {Liveness::stale, std::chrono::seconds{2}, {}};
  status.missing_b_scans = 3;
  status.notice = "Camera lost: looking for it again";
  constexpr int most = 8; // pixels that an edge just covers or just does not
  for (const StereoMode mode : {StereoMode::side_by_side, StereoMode::top_bottom})
    for (const LayoutKind kind : {LayoutKind::volume, LayoutKind::b_scan, LayoutKind::quad}) {
      ViewState view;
      view.stereo = mode;
      view.layout = kind;
      view.b_scan = 12; // missing, so hatched
      view.zoom_to_tissue = false;
      const pipeline::Image image = draw(view, status);
      const Layout layout =
          lay_out(width, height, {3.0 / 1.792, 1, 4.0 / 3, true, 3.0 / 1.792}, kind);
      const EyeFrame left = eye_frame(mode, StereoEye::left, width, height);
      const EyeFrame right = eye_frame(mode, StereoEye::right, width, height);
      const auto differing = [&](const Rect& rect) {
        const Rect a = left.place(rect);
        const Rect b = right.place(rect);
        int count = 0;
        for (int y = 0; y < a.height; ++y)
          for (int x = 0; x < a.width; ++x)
            count += differ(image.pixel(a.x + x, a.y + y), image.pixel(b.x + x, b.y + y)) ? 1 : 0;
        return count;
      };
      for (const Rect* same :
           {&layout.status_bar, &layout.b_scan.frame, &layout.en_face.frame, &layout.scope.frame})
        EXPECT_LE(differing(*same), most) << "at " << same->x << ", " << same->y;
      EXPECT_LE(differing(layout.crossed.frame), most + 4) << "its lines have more edges";
      if (kind != LayoutKind::volume) {
        EXPECT_LE(differing(layout.marks), most);
      }
      EXPECT_GT(differing(layout.view), 500);
    }
}

TEST_F(StereoPicture, without_parallax_both_eyes_see_the_same) {
  ViewState view;
  view.stereo = StereoMode::side_by_side;
  view.parallax_deg = 0;
  const pipeline::Image image = draw(view, live_status());
  int differing = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width / 2; ++x)
      differing += differ(image.pixel(x, y), image.pixel(x + width / 2, y)) ? 1 : 0;
  EXPECT_EQ(differing, 0);
}

} // namespace
} // namespace octascope::tests
