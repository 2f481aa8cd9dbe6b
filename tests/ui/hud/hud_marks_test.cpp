// The heads-up display in every layout: text sizes, room, and what it covers.
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <imgui.h>

#include "tests/ui/support/renderer_stage.h"
#include "ui/hud/hud.h"
#include "ui/layout/box_edges.h"
#include "ui/layout/stereo.h"

namespace octascope::tests {
namespace {

using namespace ui;

constexpr std::array kinds{LayoutKind::volume, LayoutKind::b_scan, LayoutKind::microscope,
                           LayoutKind::quad};
constexpr std::array sizes{std::pair{1920, 1080}, std::pair{1280, 720},  std::pair{3840, 2160},
                           std::pair{1024, 768},  std::pair{1600, 1200}, std::pair{1280, 1024}};
constexpr PictureAspects aspects{3.0 / 1.792, 1, 4.0 / 3, true, 3.0 / 1.792};

class HudInAllSizes : public GlTest {};

TEST_F(HudInAllSizes, glyphs_fit_into_the_textures_that_gles_3_promises) {
  for (const auto& [width, height] : sizes) {
    const auto fonts = Fonts::create(lay_out(width, height, aspects).unit);
    ASSERT_TRUE(fonts) << fonts.error().message;
    EXPECT_LE(fonts->atlas().TexWidth, 2048) << width;
    EXPECT_LE(fonts->atlas().TexHeight, 2048) << width;
  }
}

// In every size and layout, each badge of the text with its place.
template <class Look> void for_each_badge(const HudText& text, const Look& look) {
  for (const auto& [width, height] : sizes)
    for (const LayoutKind kind : kinds) {
      const Layout layout = lay_out(width, height, aspects, kind);
      const auto fonts = Fonts::create(layout.unit);
      ASSERT_TRUE(fonts) << fonts.error().message;
      Canvas canvas;
      canvas.begin(*fonts, width, height);
      const BadgePlaces places = place_badges(canvas, layout, text);
      for (std::size_t i = 0; i < text.badge_count; ++i) {
        SCOPED_TRACE(testing::Message()
                     << width << "x" << height << ", kind " << static_cast<int>(kind) << ", "
                     << text.badges[i].text.view());
        look(text.badges[i].kind, places[i], layout);
      }
    }
}

ShownPictures one_volume() {
  ShownPictures shown;
  shown.volume = true;
  return shown;
}

ViewState cut_open() {
  ViewState view;
  view.cut = CutShape::b_scan;
  return view;
}

TEST_F(HudInAllSizes, all_badges_find_room) {
  Status status = worst_status();
  status.rolling.emplace().seam = {std::chrono::seconds{59}, std::chrono::seconds{60}};
  const HudText text = compose_hud_text(cut_open(), status, one_volume());
  // All but the configuration's: the notice line says that, too, where one more finds no room; and
  // a replay's, below.
  ASSERT_GE(text.badge_count, HudText::most_badges - 3);
  for_each_badge(text, [](BadgeKind, const Rect& badge, const Layout& layout) {
    EXPECT_GE(badge.x, layout.marks.x);
    EXPECT_GE(badge.y, layout.marks.y);
    EXPECT_LE(badge.right(), layout.marks.right());
    EXPECT_LE(badge.bottom(), layout.marks.bottom());
  });
}

// Where everything is said at once, no lower than what is said of a replay.
TEST_F(HudInAllSizes, that_the_calibration_is_another_cameras_finds_room_beside_all_others) {
  Status status = worst_status();
  status.another_camera = true;
  const HudText text = compose_hud_text({}, status, {});
  for_each_badge(text, [](BadgeKind kind, const Rect& badge, const Layout& layout) {
    if (kind == BadgeKind::calibration) {
      EXPECT_LE(badge.right(), layout.marks.right());
      EXPECT_LE(badge.bottom(), layout.large.y + layout.large.height * 2 / 5);
    }
  });
}

// In whatever state it is: within the marks.
TEST_F(HudInAllSizes, what_is_said_of_a_replay_finds_room) {
  Status status = worst_status();
  status.freshness = {Liveness::frozen, std::chrono::seconds{3599}, std::chrono::seconds{3599}};
  status.replay = ReplayStatus{.recorded = "2026-11-22 12:10:03"};
  const HudText text = compose_hud_text(cut_open(), status, one_volume());
  ASSERT_EQ(text.badge_count, HudText::most_badges - 3); // nor does a replay roll
  for_each_badge(text, [](BadgeKind kind, const Rect& badge, const Layout& layout) {
    EXPECT_LE(badge.right(), layout.marks.right());
    EXPECT_LE(badge.bottom(), layout.marks.bottom());
    // What finds none is in the status bar.
    EXPECT_TRUE(!badge.empty() || kind == BadgeKind::incomplete ||
                kind == BadgeKind::unregistered || kind == BadgeKind::cut);
  });
}

// Alone beside a large one it has the same middle, and room for the letters that go below their line.
TEST_F(HudInAllSizes, a_small_badge_alone_has_room_that_two_share) {
  Status status = live_status();
  status.rolling.emplace().seam = {std::chrono::seconds{1}, std::chrono::seconds{2}};
  const HudText one = compose_hud_text({}, status, one_volume());
  const HudText two = compose_hud_text(cut_open(), status, one_volume());
  ASSERT_EQ(one.badge_count, 2U);
  ASSERT_EQ(two.badge_count, 3U);
  std::vector<int> shared;
  for_each_badge(two, [&](BadgeKind kind, const Rect& badge, const Layout&) {
    if (kind == BadgeKind::rolling)
      shared.push_back(badge.height);
  });
  std::size_t next = 0;
  Rect large;
  for_each_badge(one, [&](BadgeKind kind, const Rect& badge, const Layout& layout) {
    if (kind == BadgeKind::simulated)
      large = badge;
    if (kind != BadgeKind::rolling)
      return;
    EXPECT_GT(static_cast<float>(badge.height),
              static_cast<float>(shared.at(next++)) + 4 * layout.unit);
    EXPECT_NEAR(badge.y + badge.bottom(), large.y + large.bottom(), 1) << "not in its middle";
  });
  EXPECT_EQ(next, shared.size());
}

class HudInAllLayouts : public RendererTest {
protected:
  static constexpr int width = 1280;
  static constexpr int height = 720;

  void SetUp() override {
    open_renderer(width, height);
    if (!IsSkipped())
      show_scene();
  }
};

TEST_F(HudInAllLayouts, nothing_hides_the_middle_of_the_large_picture) {
  Status clean = live_status();
  clean.simulated = false;
  for (const LayoutKind kind : kinds) {
    ViewState view;
    view.layout = kind;
    view.b_scan = 20;
    const Layout layout = lay_out(width, height, aspects, kind);
    const Rect& large = layout.large;
    const Rect middle{large.x + (large.width + 3) / 4, large.y + (large.height + 3) / 4,
                      large.width / 2 - 1, large.height / 2 - 1};
    const pipeline::Image plain = draw(view, clean);
    Status worst = worst_status();
    view.echo.action = Action::window_size;
    view.echo.until = worst.now + std::chrono::seconds{1};
    for (const Liveness liveness : {Liveness::stale, Liveness::frozen}) {
      worst.freshness = {liveness, std::chrono::seconds{3000}, std::chrono::seconds{3000}};
      EXPECT_EQ(changed(plain, draw(view, worst), middle), 0) << static_cast<int>(kind);
    }
  }
}

TEST_F(HudInAllLayouts, nothing_old_looks_live_in_any_layout_nor_to_any_eye) {
  for (const LayoutKind kind : kinds)
    for (const StereoMode stereo :
         {StereoMode::off, StereoMode::side_by_side, StereoMode::top_bottom}) {
      ViewState view;
      view.layout = kind;
      view.stereo = stereo;
      const Layout layout = lay_out(width, height, aspects, kind);
      Status status = live_status();
      const pipeline::Image live = draw(view, status);
      for (const Liveness liveness :
           {Liveness::stale, Liveness::frozen, Liveness::veiled, Liveness::replayed}) {
        status.freshness = {liveness, std::chrono::seconds{7}, std::chrono::seconds{7}};
        if (liveness == Liveness::replayed)
          status.replay = ReplayStatus{.recorded = "2026-11-22 12:10:03"};
        const pipeline::Image old = draw(view, status);
        for (const StereoEye eye : eyes_of(stereo)) {
          const EyeFrame frame = eye_frame(stereo, eye, width, height);
          EXPECT_GT(changed(live, old, frame.place(layout.marks)), 1000)
              << "no badge, layout " << static_cast<int>(kind);
          for (const Rect* picture : {&layout.view, &layout.b_scan.picture, &layout.crossed.picture,
                                      &layout.en_face.picture}) {
            if (picture->empty())
              continue;
            const Rect seen = frame.place(*picture);
            EXPECT_GT(changed(live, old, seen), seen.width + seen.height)
                << "no frame, layout " << static_cast<int>(kind);
          }
        }
      }
    }
}

TEST_F(HudInAllLayouts, an_old_microscope_picture_is_framed_and_dark_in_every_layout) {
  for (const LayoutKind kind : kinds) {
    ViewState view;
    view.layout = kind;
    const Rect rect = lay_out(width, height, aspects, kind).scope.picture;
    const pipeline::Image live = draw(view, live_status());
    Status later = live_status();
    later.now += std::chrono::seconds{3};
    EXPECT_GT(changed(live, draw(view, later), rect), rect.width * rect.height * 9 / 10);
  }
}

TEST_F(HudInAllLayouts, missing_b_scans_show_in_the_volume_itself) {
  auto volume = tissue_volume(small_geometry);
  ViewState view;
  view.b_scan = 30;
  const Rect rect = lay_out(width, height, aspects).view;
  const auto warnings = [&] {
    const pipeline::Image image = draw(view, live_status());
    int count = 0;
    for (int y = rect.height / 8; y < rect.height; ++y)
      for (int x = 0; x < rect.width; ++x) {
        const auto p = image.pixel(x, y);
        count += p[0] > 240 && p[1] > 170 && p[1] < 200 && p[2] < 100 ? 1 : 0;
      }
    return count;
  };
  EXPECT_EQ(warnings(), 0);
  volume.b_scan_states[12] = pipeline::BScanState::missing;
  ASSERT_TRUE(renderer_->show_volume(volume));
  const int one = warnings();
  EXPECT_GT(one, 30);
  for (const std::size_t b : {13U, 14U, 15U})
    volume.b_scan_states[b] = pipeline::BScanState::missing;
  ASSERT_TRUE(renderer_->show_volume(volume));
  EXPECT_GT(warnings(), 2 * one);
}

TEST_F(HudInAllLayouts, the_histogram_shows_while_the_window_is_turned_and_only_then) {
  const Rect rect = lay_out(width, height, aspects).histogram;
  const Status status = live_status();
  ViewState view;
  const pipeline::Image plain = draw(view, status);
  view.echo.until = status.now + std::chrono::seconds{1};
  view.echo.action = Action::tilt;
  EXPECT_EQ(changed(plain, draw(view, status), rect), 0);
  view.echo.action = Action::window_offset;
  const pipeline::Image shown = draw(view, status);
  EXPECT_GT(changed(plain, shown, rect), rect.width * rect.height / 2);
  view.window_offset_db += 10;
  EXPECT_GT(changed(shown, draw(view, status), rect), 100) << "the ramp moves";
}

TEST(HudText, a_volume_that_is_cut_says_where) {
  ViewState view;
  view.b_scan = 40;
  ShownPictures shown;
  shown.volume = true;
  const std::size_t without = compose_hud_text(view, live_status(), shown).badge_count;
  view.cut = CutShape::corner;
  EXPECT_EQ(compose_hud_text(view, live_status(), shown).badges[without].text.view(),
            "cut at both B-scans");
  view.cut = CutShape::b_scan;
  const HudText text = compose_hud_text(view, live_status(), shown);
  ASSERT_EQ(text.badge_count, without + 1);
  EXPECT_EQ(text.badges[without].text.view(), "cut at B-scan 41");
  EXPECT_EQ(compose_hud_text(view, live_status(), {}).badge_count, without) << "nothing to cut";
}

TEST(HudText, reduced_quality_is_said_quietly) {
  Status status = live_status();
  EXPECT_TRUE(compose_hud_text({}, status, {}).facts[2].empty());
  status.reduced_quality = 0.678F;
  const HudText text = compose_hud_text({}, status, {});
  EXPECT_EQ(text.facts[2].view(), "quality reduced to 67 %") << "rounded down";
}

// Corners of the slice against the matrices, and the box's own edges for what is in front.
TEST(BoxMarks, a_slice_lies_between_the_boxs_edges) {
  constexpr glm::vec3 extents{3, 1.8F, 2.4F};
  ViewState view;
  view.yaw_deg = 30;
  view.tilt_deg = 25;
  const Camera camera = make_camera(view, extents, 1);
  const Rect rect{0, 0, 400, 400};
  const auto at = [&](float x, float y, float z) {
    const glm::vec2 p = camera.project({x, y, z}) * 400.0F;
    return glm::vec2{200 + p.x, 200 + p.y};
  };
  const auto slice = project_slice(camera, extents, SliceAcross::slow, 0.75F, rect);
  int in_front = 0;
  for (const BoxEdge& edge : slice) {
    in_front += edge.in_front ? 1 : 0;
    for (const glm::vec2 end : {edge.from, edge.to}) {
      float nearest = 1e9F;
      for (const float x : {-1.5F, 1.5F})
        for (const float y : {-0.9F, 0.9F})
          nearest = std::min(nearest, glm::length(end - at(x, y, 0.6F)));
      EXPECT_LT(nearest, 0.01F);
    }
  }
  EXPECT_EQ(in_front, 2) << "on the upper face and on the one towards the eye";
  for (const BoxEdge& edge : project_slice(camera, extents, SliceAcross::fast, 0.25F, rect))
    for (const glm::vec2 end : {edge.from, edge.to}) {
      float nearest = 1e9F;
      for (const float y : {-0.9F, 0.9F})
        for (const float z : {-1.2F, 1.2F})
          nearest = std::min(nearest, glm::length(end - at(-0.75F, y, z)));
      EXPECT_LT(nearest, 0.01F) << "the crossed one";
    }
  const auto edges = project_slow_edges(camera, extents, 0, 1, rect);
  for (const BoxEdge& edge : edges)
    EXPECT_TRUE(std::ranges::any_of(project_box(camera, extents, rect), [&](const BoxEdge& other) {
      return glm::length(edge.from - other.from) + glm::length(edge.to - other.to) < 0.01F &&
             edge.in_front == other.in_front;
    }));
}

} // namespace
} // namespace octascope::tests
