#include <algorithm>

#include <gmock/gmock.h>

#include "tests/ui/support/picture_file.h"
#include "tests/ui/support/renderer_stage.h"
#include "ui/hud/hud.h"

namespace octascope::tests {
namespace {

using namespace ui;

TEST(ScaleBar, lengths_are_round) {
  EXPECT_DOUBLE_EQ(round_scale_length_mm(1.9), 1);
  EXPECT_DOUBLE_EQ(round_scale_length_mm(2), 2);
  EXPECT_DOUBLE_EQ(round_scale_length_mm(0.7), 0.5);
  EXPECT_NEAR(round_scale_length_mm(0.049), 0.02, 1e-12);
}

TEST(ScaleBar, says_in_what_medium_depths_hold) {
  EXPECT_EQ(medium_words(1.38).view(), "n 1.38");
  EXPECT_EQ(medium_words(1.0).view(), "in air");
  EXPECT_EQ(medium_words(1.0003).view(), "in air") << "air's own";
  EXPECT_EQ(medium_words(1.01).view(), "n 1.01");
  EXPECT_EQ(medium_words(2.0).view(), "n 2.00");
  EXPECT_EQ(medium_words({}).view(), "n ?") << "nobody said";
}

class HudPicture : public RendererTest {
protected:
  static constexpr int width = 640;
  static constexpr int height = 360;
};

TEST_F(HudPicture, the_colours_of_vessels_are_explained_beside_the_centre) {
  ASSERT_TRUE(renderer_->show_volume(tissue_volume(small_geometry)));
  Status status = live_status();
  status.vessels.registered = true;
  ViewState view;
  view.vessel_account = true;
  const auto before = draw(view, status);
  status.vessels.state = VesselStatus::State::shown;
  status.vessels.branches = {false, true, true, true};
  const auto after = draw(view, status);
  EXPECT_GT(changed(before, after, {0, 0, width, height}), 500);
  const Rect large = lay_out(width, height, {}).view;
  EXPECT_EQ(changed(before, after,
                    {large.x + large.width / 4, large.y + large.height / 4, large.width / 2,
                     large.height / 2}),
            0);
}

TEST_F(HudPicture, the_bars_along_depth_say_in_what_medium_they_hold) {
  const auto with = [&](std::optional<double> refractive_index) {
    pipeline::VolumeGeometry geometry = small_geometry;
    geometry.refractive_index = refractive_index;
    EXPECT_TRUE(renderer_->show_volume(tissue_volume(geometry)));
    return draw({}, live_status());
  };
  const pipeline::Image tissue = with(1.38);
  const pipeline::Image unknown = with(std::nullopt);
  const Layout layout = lay_out(width, height, {3.0 / 1.792, 1, 4.0 / 3, false}); // nobody looks on
  const auto lower_left = [](const Rect& rect) {
    return Rect{rect.x, rect.bottom() - rect.height / 4, rect.width / 2, rect.height / 4};
  };
  EXPECT_GT(changed(tissue, unknown, lower_left(layout.view)), 20);
  EXPECT_GT(changed(tissue, unknown, lower_left(layout.b_scan.picture)), 20);
  EXPECT_EQ(changed(tissue, unknown, layout.en_face.picture), 0) << "no depth is seen there";
  EXPECT_GT(changed(tissue, with(1.0), lower_left(layout.view)), 20);
}

// REPLAY is told from every other state without its words: another plate, another frame.
TEST_F(HudPicture, a_replay_looks_like_nothing_else) {
  ASSERT_TRUE(renderer_->show_volume(tissue_volume(small_geometry)));
  Status status = live_status();
  status.simulated = false;
  const Layout layout = lay_out(width, height, {});
  const auto plate = [&](const Status& shown, Colour colour) {
    const pipeline::Image picture = draw({}, shown);
    int count = 0;
    for (int y = layout.marks.y; y < layout.marks.bottom(); ++y)
      for (int x = layout.marks.x; x < layout.marks.right(); ++x)
        count += picture.pixel(x, y) == std::array{colour.r, colour.g, colour.b} ? 1 : 0;
    return count;
  };
  for (const Liveness liveness :
       {Liveness::waiting, Liveness::live, Liveness::stale, Liveness::frozen}) {
    status.freshness = {liveness, std::chrono::seconds{2}, std::chrono::seconds{2}};
    status.simulated = !status.simulated;
    EXPECT_LT(plate(status, palette::replay), 500) << "no other has a white plate";
  }
  status.freshness = {Liveness::replayed, {}, {}};
  status.replay = ReplayStatus{.recorded = "2026-11-22 12:10:03"};
  EXPECT_GT(plate(status, palette::replay), 1500);
  EXPECT_LT(plate(status, palette::warning) + plate(status, palette::frozen), 20);
}

TEST_F(HudPicture, is_drawn_again_only_when_it_would_look_different) {
  Status status = live_status();
  ViewState view;
  EXPECT_TRUE(renderer_->needs_redraw(view, status, width, height));
  draw(view, status);
  EXPECT_FALSE(renderer_->needs_redraw(view, status, width, height));
  status.now += std::chrono::milliseconds{16};
  status.frames_per_s += 0.01;
  EXPECT_FALSE(renderer_->needs_redraw(view, status, width, height)) << "the same in words";
  status.freshness = {Liveness::stale, std::chrono::seconds{1}, {}};
  EXPECT_TRUE(renderer_->needs_redraw(view, status, width, height));
  draw(view, status);
  view.tilt_deg += 1;
  EXPECT_TRUE(renderer_->needs_redraw(view, status, width, height));
  draw(view, status);
  EXPECT_TRUE(renderer_->needs_redraw(view, status, width + 1, height));
  ASSERT_TRUE(renderer_->show_volume(uniform_volume({8, 8, 8, 1, 1, 1}, 100)));
  EXPECT_TRUE(renderer_->needs_redraw(view, status, width, height));
}

TEST_F(HudPicture, what_needs_no_redraw_is_the_same_to_the_pixel) {
  ASSERT_TRUE(renderer_->show_volume(tissue_volume(small_geometry)));
  Status status = live_status();
  const pipeline::Image first = draw({}, status);
  status.now += std::chrono::milliseconds{16};
  ASSERT_FALSE(renderer_->needs_redraw({}, status, width, height));
  EXPECT_EQ(compare(first, draw({}, status)).largest, 0);
}

TEST_F(HudPicture, leaves_no_gl_error_and_the_target_bound) {
  ASSERT_TRUE(renderer_->show_volume(tissue_volume(small_geometry)));
  GLint before = 0;
  glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &before);
  draw({}, live_status());
  GLint after = 0;
  glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &after);
  EXPECT_EQ(before, after);
  EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
  EXPECT_FALSE(renderer_->draw({}, live_status(), 0, 10));
}

TEST_F(HudPicture, badges_change_the_corner_and_never_the_centre) {
  ASSERT_TRUE(renderer_->show_volume(tissue_volume(small_geometry)));
  Status status = live_status();
  status.simulated = false;
  const pipeline::Image live = draw({}, status);
  const Layout layout = lay_out(width, height, {});
  const Rect corner{0, 0, layout.view.width, layout.view.height / 4};
  const Rect centre{layout.view.width / 4, layout.view.height / 4, layout.view.width / 2,
                    layout.view.height / 2};
  for (const Liveness liveness : {Liveness::stale, Liveness::frozen}) {
    status.freshness = {liveness, std::chrono::seconds{2}, std::chrono::seconds{2}};
    const pipeline::Image marked = draw({}, status);
    EXPECT_GT(changed(live, marked, corner), 500);
    EXPECT_EQ(changed(live, marked, centre), 0);
  }
  status.freshness = live_status().freshness;
  status.simulated = true;
  EXPECT_GT(changed(live, draw({}, status), corner), 200);
}

TEST_F(HudPicture, a_veiled_picture_is_dark_all_over) {
  ASSERT_TRUE(renderer_->show_volume(tissue_volume(small_geometry)));
  Status status = live_status();
  const auto brightness = [&](const pipeline::Image& image) {
    const Layout layout = lay_out(width, height, {});
    double sum = 0;
    for (int y = 60; y < layout.view.height - 20; ++y)
      for (int x = 20; x < layout.view.width - 20; ++x)
        sum += image.pixel(x, y)[1];
    return sum;
  };
  const double live = brightness(draw({}, status));
  status.freshness = {Liveness::veiled, std::chrono::seconds{9}, {}};
  EXPECT_LT(brightness(draw({}, status)), 0.45 * live);
}

} // namespace
} // namespace octascope::tests
