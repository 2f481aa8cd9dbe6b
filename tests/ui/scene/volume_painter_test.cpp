// The volume on the display: whoever draws it, it is the same picture, kept while it holds.
#include <algorithm>
#include <array>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "pipeline/files/png_image.h"
#include "pipeline/volume/level_scale.h"
#include "pipeline/volume/volume_geometry.h"
#include "tests/ui/support/gl_test.h"
#include "tests/ui/support/picture_file.h"
#include "tests/ui/support/scene.h"
#include "tests/ui/support/synthetic_volume.h"
#include "ui/scene/volume_painter.h"

namespace octascope::tests {
namespace {

constexpr int width = 320;
constexpr int height = 200;
constexpr ui::Rect rect{0, 0, width, height};
constexpr ui::DrawQuality by_processor{1, 512, ui::RayBackend::processor};
constexpr ui::DrawQuality by_shader{1, 512, ui::RayBackend::shader};

ui::ViewState view_from(float yaw_deg, float tilt_deg, float distance, float opacity = 0.5F) {
  ui::ViewState view;
  view.yaw_deg = yaw_deg;
  view.tilt_deg = tilt_deg;
  view.distance = distance;
  view.opacity = opacity;
  return view;
}

class VolumePainterTest : public GlTest {
protected:
  void SetUp() override {
    open(width, height);
    if (IsSkipped())
      return;
    auto made = ui::VolumePainter::create();
    ASSERT_TRUE(made) << made.error().message;
    painter_.emplace(std::move(*made));
  }
  void TearDown() override { painter_.reset(); }

  ui::Camera camera(const ui::ViewState& view) const {
    return ui::make_camera(view, ui::box_extents_mm(painter_->texture().geometry()),
                           static_cast<float>(width) / height);
  }

  hal::Result<> show(const pipeline::Volume& volume) {
    shown_ = volume;
    return painter_->show(volume);
  }

  pipeline::Image draw(const ui::ViewState& view, const ui::DrawQuality& quality, float ground = 0,
                       ui::StereoEye eye = ui::StereoEye::left) {
    const auto ready = painter_->finish(shown_, view);
    EXPECT_TRUE(ready) << ready.error().message;
    const auto updated = painter_->update(eye, view, camera(view), quality, rect);
    EXPECT_TRUE(updated) << updated.error().message;
    return composite(ground, eye);
  }

  pipeline::Image composite(float ground, ui::StereoEye eye) const {
    glViewport(0, 0, width, height);
    glClearColor(ground, ground, ground, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    painter_->composite(eye, rect, height);
    pipeline::Image image{width, height, 3};
    std::vector<std::uint8_t> rgba(4 * width * height);
    glReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
    for (std::size_t i = 0; i < rgba.size() / 4; ++i)
      for (std::size_t c = 0; c < 3; ++c)
        image.pixels[3 * i + c] = rgba[4 * i + c];
    return image;
  }

  static int brightest(const pipeline::Image& image) {
    return *std::max_element(image.pixels.begin(), image.pixels.end());
  }

  std::optional<ui::VolumePainter> painter_;
  pipeline::Volume shown_;
};

TEST_F(VolumePainterTest, computes_no_flow_that_is_hidden) {
  pipeline::Volume volume = tissue_volume(small_geometry);
  add_tubes(volume);
  ui::ViewState view;
  view.vessels = ui::VesselsShown::off;
  painter_->expect(view);
  ASSERT_TRUE(show(volume));
  EXPECT_FALSE(painter_->has_flow_computed());
  view.vessels = ui::VesselsShown::flow;
  EXPECT_TRUE(painter_->wants_volume(view));
  painter_->expect(view);
  ASSERT_TRUE(show(volume));
  EXPECT_TRUE(painter_->has_flow_computed());
}

TEST_F(VolumePainterTest, processor_shader_and_planes_make_the_same_picture) {
  pipeline::Volume volume = tissue_volume(small_geometry);
  for (const bool incomplete : {false, true}) {
    if (incomplete)
      mark_incomplete(volume);
    ASSERT_TRUE(show(volume));
    for (ui::ViewState view : {view_from(35, 35, 2.4F, 0.5F), view_from(80, 10, 0.7F, 0.03F)})
      for (const float ground : {0.0F, 1.0F}) { // colour, and colour and opacity together
        const std::string what = std::string{incomplete ? "incomplete" : "whole"} + ", yaw " +
                                 std::to_string(view.yaw_deg) + " on " + std::to_string(ground);
        view.technique = ui::Technique::rays;
        const pipeline::Image processor = draw(view, by_processor, ground);
        const pipeline::Image shader = draw(view, by_shader, ground);
        view.technique = ui::Technique::planes;
        const pipeline::Image planes = draw(view, {1, 1024}, ground);
        EXPECT_LE(compare(processor, shader).mean, 1) << what;
        EXPECT_LE(compare(processor, planes).mean, 2) << what;
        EXPECT_LE(compare(shader, planes).mean, 2) << what;
      }
  }
}

// The volume is shown anew behind the painter's back: only what is drawn again can tell.
TEST_F(VolumePainterTest, draws_again_only_when_something_changed) {
  for (const ui::Technique technique : ui::all_techniques)
    for (const ui::DrawQuality& quality : {by_shader, by_processor}) {
      ASSERT_TRUE(show(tissue_volume(small_geometry)));
      ui::ViewState view = view_from(35, 35, 2.4F);
      view.technique = technique;
      const pipeline::Image first = draw(view, quality);
      EXPECT_GT(brightest(first), 50) << ui::to_string(technique);
      view.b_scan += 1; // shows elsewhere only
      view.legend_visible = !view.legend_visible;
      EXPECT_EQ(draw(view, quality).pixels, first.pixels);
      const auto changed = [&](auto&& change) {
        ui::ViewState other = view;
        change(other);
        EXPECT_NE(draw(other, quality).pixels, first.pixels) << ui::to_string(technique);
        EXPECT_EQ(draw(view, quality).pixels, first.pixels) << ui::to_string(technique);
      };
      changed([](ui::ViewState& v) { v.yaw_deg += 5; });
      changed([](ui::ViewState& v) { v.tilt_deg += 5; });
      changed([](ui::ViewState& v) { v.distance += 0.2F; });
      changed([](ui::ViewState& v) { v.window_offset_db += 3; });
      changed([](ui::ViewState& v) { v.window_size_db += 5; });
      ASSERT_TRUE(show(uniform_volume(small_geometry, 0)));
      EXPECT_EQ(brightest(draw(view, quality)), 0) << "the volume is empty now";
    }
}

TEST_F(VolumePainterTest, eyes_have_their_own_pictures) {
  ASSERT_TRUE(show(tissue_volume(small_geometry)));
  const ui::ViewState left = view_from(33, 35, 2.4F);
  const ui::ViewState right = view_from(37, 35, 2.4F);
  for (const ui::DrawQuality& quality : {by_shader, by_processor}) {
    const pipeline::Image from_left = draw(left, quality, 0, ui::StereoEye::left);
    const pipeline::Image from_right = draw(right, quality, 0, ui::StereoEye::right);
    EXPECT_NE(from_left.pixels, from_right.pixels);
    EXPECT_EQ(composite(0, ui::StereoEye::left).pixels, from_left.pixels);
    EXPECT_EQ(draw(right, quality, 0, ui::StereoEye::left).pixels, from_right.pixels);
  }
}

TEST_F(VolumePainterTest, takes_an_occupancy_that_is_ready) {
  const pipeline::Volume volume = tissue_volume(small_geometry);
  ASSERT_TRUE(show(volume));
  const ui::ViewState view = view_from(35, 35, 2.4F);
  const pipeline::Image own = draw(view, by_shader);
  pipeline::Occupancy occupancy{small_geometry, pipeline::blank_depth_bins};
  occupancy.update(volume);
  ASSERT_TRUE(painter_->show(volume, occupancy));
  EXPECT_EQ(draw(view, by_shader).pixels, own.pixels);
  // Nothing in it: all is leapt over, so it is this one that is used.
  occupancy.update(uniform_volume(small_geometry, 0));
  ASSERT_TRUE(painter_->show(volume, occupancy));
  EXPECT_EQ(brightest(draw(view, by_shader)), 0);
  EXPECT_EQ(brightest(draw(view, by_processor)), 0);

  const auto other = painter_->show(volume, pipeline::Occupancy{full_geometry, 2});
  ASSERT_FALSE(other);
  EXPECT_EQ(other.error().code, hal::ErrorCode::invalid_argument);
}

TEST_F(VolumePainterTest, says_who_casts_the_rays) {
  EXPECT_EQ(painter_->backend(by_processor), ui::RayBackend::shader) << "nothing to draw yet";
  ASSERT_TRUE(show(tissue_volume(small_geometry)));
  EXPECT_EQ(painter_->backend(by_shader), ui::RayBackend::shader);
  draw(view_from(0, 0, 3), by_processor); // asks for it
  ASSERT_TRUE(show(tissue_volume(small_geometry)));
  EXPECT_EQ(painter_->backend(by_processor), ui::RayBackend::processor);
}

TEST_F(VolumePainterTest, sets_up_every_thread_that_it_starts) {
  std::mutex mutex;
  std::multiset<std::string> roles;
  const auto note = [&](pipeline::ThreadRole role) {
    const std::lock_guard lock{mutex};
    roles.emplace(role.name);
  };
  auto made = ui::VolumePainter::create({}, note);
  ASSERT_TRUE(made) << made.error().message;
  painter_.emplace(std::move(*made));
  const auto volume = tissue_volume(small_geometry);
  ASSERT_TRUE(painter_->show(volume));
  draw({}, by_processor); // the helpers are wanted
  ui::ViewState view;
  view.technique = ui::Technique::surface;
  ASSERT_TRUE(painter_->finish(volume, view));
  painter_.reset(); // its threads have ended
  const std::size_t helpers = std::min(std::max(std::thread::hardware_concurrency(), 1U) - 1, 15U);
  EXPECT_EQ(roles.count("rays"), helpers);
  EXPECT_EQ(roles.count("surface"), 1U);
  EXPECT_EQ(roles.size(), helpers + 1);
}

// A dim sheet over bright tissue, with a gap: only the sheet is drawn weaker, by whoever draws it.
TEST_F(VolumePainterTest, sees_through_what_covers_tissue) {
  pipeline::Volume volume = uniform_volume(small_geometry, 40);
  for (int b = 0; b < small_geometry.b_scans; ++b)
    for (int a = 0; a < small_geometry.a_scans; ++a) {
      const auto column = volume.b_scan(b).begin() + a * small_geometry.depths;
      std::fill_n(column + 16, 24, std::uint8_t{110});
      std::fill_n(column + 80, 24, std::uint8_t{150});
    }
  ASSERT_TRUE(show(volume));
  ui::ViewState view = view_from(35, 60, 2.4F);
  const auto middle = [&](const pipeline::Image& picture) {
    return int{picture.pixel(width / 2, height / 2)[1]};
  };
  const auto with = [&](float see_through_db, ui::Technique technique,
                        const ui::DrawQuality& quality) {
    view.see_through_db = see_through_db;
    view.technique = technique;
    return draw(view, quality);
  };
  const pipeline::Image processor = with(11, ui::Technique::rays, by_processor);
  const pipeline::Image shader = with(11, ui::Technique::rays, by_shader);
  EXPECT_LE(compare(processor, shader).mean, 1);
  EXPECT_LE(compare(shader, with(11, ui::Technique::planes, {1, 1024})).mean, 2);
  for (const ui::Technique technique : ui::all_techniques)
    for (const ui::DrawQuality& quality : {by_shader, by_processor}) {
      const int solid = middle(with(0, technique, quality));
      const int seen_through = middle(with(14, technique, quality));
      if (technique == ui::Technique::surface || technique == ui::Technique::maximum)
        EXPECT_EQ(seen_through, solid) << to_string(technique);
      else
        EXPECT_GE(seen_through, solid + 15) << to_string(technique);
    }
  // A view that asks for more than the shown volume has is given it with the next.
  view.see_through_db = 5;
  EXPECT_TRUE(painter_->wants_volume(view));
  draw(view, by_processor);
  EXPECT_FALSE(painter_->wants_volume(view));
}

// The mesh is made beside the render thread: until it is finished, the last one is drawn as it was, with
// its own volume's glass and metal.
TEST_F(VolumePainterTest, an_iso_surface_is_of_one_volume) {
  const auto layers = [](std::uint8_t sheet, std::uint8_t tissue) {
    pipeline::Volume volume = uniform_volume(small_geometry, 40);
    for (int b = 0; b < small_geometry.b_scans; ++b)
      for (int a = 0; a < small_geometry.a_scans; ++a) {
        const auto column = volume.b_scan(b).begin() + a * small_geometry.depths;
        std::fill_n(column + 16, 24, sheet);
        std::fill_n(column + 80, 24, tissue);
      }
    return volume;
  };
  ui::ViewState view = view_from(35, 60, 2.4F);
  view.technique = ui::Technique::surface;
  const std::array volumes{layers(110, 220), layers(220, 40)}; // glass over metal, metal alone
  std::array<pipeline::Image, 2> pictures;
  for (const std::size_t i : {0U, 1U}) {
    ASSERT_TRUE(show(volumes[i]));
    pictures[i] = draw(view, by_shader);
  }
  ASSERT_GT(compare(pictures[0], pictures[1]).mean, 5);
  for (std::size_t i = 0; i < 10; ++i) {
    ASSERT_TRUE(painter_->show(volumes[i % 2]));
    for (const bool whole : {false, true}) {
      if (whole) {
        ASSERT_TRUE(painter_->finish(volumes[i % 2], view));
      }
      ASSERT_TRUE(painter_->update(ui::StereoEye::left, view, camera(view), by_shader, rect));
      const pipeline::Image picture = composite(0, ui::StereoEye::left);
      const bool newest = picture.pixels == pictures[i % 2].pixels;
      EXPECT_TRUE(newest || (!whole && picture.pixels == pictures[1 - i % 2].pixels)) << i;
    }
  }
}

// The mesh of such a volume takes longer than two uploads.
TEST_F(VolumePainterTest, says_that_flow_came_too_late_for_its_surface) {
  pipeline::Volume volume = tissue_volume({256, 150, 40, 7, 20, 75, 1.38});
  add_tubes(volume);
  ui::ViewState view;
  view.technique = ui::Technique::surface;
  const auto update = [&] {
    return painter_->update(ui::StereoEye::left, view, camera(view), by_shader, rect);
  };
  ASSERT_TRUE(show(volume));
  draw(view, by_shader);
  EXPECT_FALSE(painter_->flow_late(view));
  for (int i = 0; i < 20 && !painter_->flow_late(view); ++i) {
    ASSERT_TRUE(painter_->show(volume));
    ASSERT_TRUE(painter_->show(volume));
    ASSERT_TRUE(update());
  }
  ASSERT_TRUE(painter_->flow_late(view));
  view.technique = ui::Technique::rays;
  EXPECT_FALSE(painter_->flow_late(view)) << "these are in time";
  view.technique = ui::Technique::surface;
  for (int in_time = 0; in_time < 4; ++in_time) {
    EXPECT_TRUE(painter_->flow_late(view)) << in_time << ": it must not come and go";
    ASSERT_TRUE(show(volume));
    draw(view, by_shader);
  }
  EXPECT_FALSE(painter_->flow_late(view));
}

float grey_of(std::uint8_t level, const ui::ViewState& view) {
  const float from_db =
      view.window_offset_db + ui::window_lift(view.technique) * view.window_size_db;
  const float size_db = ui::window_stretch(view.technique) * view.window_size_db;
  return std::min((pipeline::level_db(level) - from_db) / size_db, 1.F);
}

// The eye is at the end of the last B-scans. What is bright lies there alone, then in one B-scan
// behind it alone.
TEST_F(VolumePainterTest, a_cut_takes_away_what_is_before_the_b_scan_and_shows_it) {
  pipeline::Volume before = uniform_volume(small_geometry, 0);
  for (int b = 25; b < 40; ++b)
    std::ranges::fill(before.b_scan(b), std::uint8_t{140});
  pipeline::Volume alone = uniform_volume(small_geometry, 0);
  std::ranges::fill(alone.b_scan(20), std::uint8_t{140});
  ui::ViewState view = view_from(10, 20, 2.4F, 0.02F);
  for (const ui::Technique technique : ui::all_techniques)
    for (const ui::DrawQuality& quality : {by_shader, by_processor}) {
      SCOPED_TRACE(to_string(technique));
      view.technique = technique;
      view.b_scan = 20;
      ASSERT_TRUE(show(before));
      view.cut = ui::CutShape::none;
      EXPECT_GT(brightest(draw(view, quality)), 30);
      view.cut = ui::CutShape::b_scan;
      EXPECT_EQ(brightest(draw(view, quality)), 0) << "all that is there is cut away";
      view.yaw_deg += 180; // seen from behind, it is what is kept
      EXPECT_GT(brightest(draw(view, quality)), 30);
      view.yaw_deg -= 180;

      ASSERT_TRUE(show(alone));
      const int face = brightest(draw(view, quality));
      EXPECT_NEAR(face, 255 * grey_of(140, view), 2)
          << "as bright as the B-scan, however clear the rest";
      view.b_scan = 30;                        // the cut follows it
      if (technique == ui::Technique::maximum) // finds it behind
        EXPECT_LE(brightest(draw(view, quality)), face);
      else
        EXPECT_LT(brightest(draw(view, quality)), face - 20);
    }
}

// The eye is at the end of the last B-scans and last A-scans. What is bright lies in the corner there
// alone; then beside it, along either axis; then in one of the crossed B-scans.
TEST_F(VolumePainterTest, a_corner_that_is_cut_leaves_what_lies_beside_it_and_shows_both_b_scans) {
  const auto bright_columns = [](int a_from, int a_to, int b_from, int b_to) {
    const auto depths = static_cast<std::size_t>(small_geometry.depths);
    pipeline::Volume volume = uniform_volume(small_geometry, 0);
    for (int b = b_from; b < b_to; ++b)
      for (int a = a_from; a < a_to; ++a)
        std::ranges::fill(volume.b_scan(b).subspan(static_cast<std::size_t>(a) * depths, depths),
                          std::uint8_t{140});
    return volume;
  };
  const int a_scans = small_geometry.a_scans;
  const int middle = a_scans / 2;
  ui::ViewState view = view_from(45, 20, 2.4F, 0.02F);
  view.b_scan = 20;
  view.a_scan = middle;
  for (const ui::Technique technique : ui::all_techniques)
    for (const ui::DrawQuality& quality : {by_shader, by_processor}) {
      SCOPED_TRACE(to_string(technique));
      view.technique = technique;
      ASSERT_TRUE(show(bright_columns(middle + 3, a_scans, 23, small_geometry.b_scans)));
      view.cut = ui::CutShape::none;
      EXPECT_GT(brightest(draw(view, quality)), 30);
      view.cut = ui::CutShape::corner;
      EXPECT_EQ(brightest(draw(view, quality)), 0) << "all that is there is cut away";
      view.yaw_deg += 180; // the opposite corner is open then
      EXPECT_GT(brightest(draw(view, quality)), 30);
      view.yaw_deg -= 180;

      for (const auto& beside : {bright_columns(0, middle - 3, 23, small_geometry.b_scans),
                                 bright_columns(middle + 3, a_scans, 0, 18)}) {
        ASSERT_TRUE(show(beside));
        EXPECT_GT(brightest(draw(view, quality)), 30) << "beside the corner, all stays";
      }

      for (const auto& on_a_face : {bright_columns(middle, middle + 1, 0, small_geometry.b_scans),
                                    bright_columns(0, a_scans, 20, 21)}) {
        ASSERT_TRUE(show(on_a_face));
        EXPECT_NEAR(brightest(draw(view, quality)), 255 * grey_of(140, view), 2) << "opaque";
      }
    }
}

} // namespace
} // namespace octascope::tests
