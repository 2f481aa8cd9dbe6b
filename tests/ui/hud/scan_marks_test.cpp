// Rulers, crossing lines and the calliper, by what they do to the picture.
#include <array>
#include <cmath>

#include "tests/ui/support/renderer_stage.h"
#include "ui/hud/hud.h"

namespace octascope::tests {
namespace {

using namespace ui;

constexpr int width = 1280;
constexpr int height = 720;

class ScanMarks : public RendererTest {
protected:
  void SetUp() override {
    open_renderer(width, height);
    if (!IsSkipped())
      show_scene();
  }

  static ViewState whole(LayoutKind kind) {
    ViewState view;
    view.layout = kind;
    view.b_scan = 20;
    view.a_scan = 50;
    view.zoom_to_tissue = false;
    return view;
  }
  static Layout places(LayoutKind kind) {
    const pipeline::VolumeGeometry& g = small_geometry;
    const double deep = g.depth_mm();
    return lay_out(width, height,
                   {g.a_mm() / deep, g.a_mm() / g.b_mm(), 4.0 / 3, true, g.b_mm() / deep}, kind);
  }
};

bool is_pink(const std::array<std::uint8_t, 3>& p) {
  return p[0] > p[1] + 9 && p[2] > p[1] + 6;
}
bool is_blue(const std::array<std::uint8_t, 3>& p) {
  return p[2] > p[0] + 20 && p[1] > p[0] + 10;
}

// How many pixels of a column or a row of a picture have that colour.
template <class Is>
int in_column(const pipeline::Image& image, const Rect& rect, double share, const Is& is) {
  const int x = rect.x + static_cast<int>(share * rect.width);
  int count = 0;
  for (int y = rect.y; y < rect.bottom(); ++y)
    count += is(image.pixel(x, y)) || is(image.pixel(x - 1, y)) ? 1 : 0;
  return count;
}
template <class Is>
int in_row(const pipeline::Image& image, const Rect& rect, double share, const Is& is) {
  const int y = rect.y + static_cast<int>(share * rect.height);
  int count = 0;
  for (int x = rect.x; x < rect.right(); ++x)
    count += is(image.pixel(x, y)) || is(image.pixel(x, y - 1)) ? 1 : 0;
  return count;
}

TEST_F(ScanMarks, each_position_is_a_line_of_its_colour_on_en_face_and_microscope_picture) {
  for (const LayoutKind kind : {LayoutKind::b_scan, LayoutKind::quad}) {
    ViewState view = whole(kind);
    view.a_scan = 25; // of 100
    view.b_scan = 30; // of 40
    const pipeline::Image picture = draw(view, live_status());
    const Rect& en_face = places(kind).en_face.picture;
    EXPECT_GT(in_column(picture, en_face, 25.5 / 100, is_pink), en_face.height / 2);
    EXPECT_GT(in_row(picture, en_face, 30.5 / 40, is_blue), en_face.width / 2);
    EXPECT_LT(in_column(picture, en_face, 0.6, is_pink), en_face.height / 20);
    EXPECT_LT(in_row(picture, en_face, 0.3, is_blue), en_face.width / 20);
    // In the microscope's picture, moving one moves its line.
    const Rect& scope = places(kind).scope.picture;
    view.a_scan = 70;
    const pipeline::Image moved = draw(view, live_status());
    EXPECT_GT(changed(picture, moved, scope), scope.height / 4);
  }
}

// What the crossed panel shows is the cross-section at its position and nothing else.
TEST_F(ScanMarks, turning_the_crossed_position_changes_its_panel_alone_among_the_b_scans) {
  ViewState view = whole(LayoutKind::b_scan);
  const Layout layout = places(LayoutKind::b_scan);
  ASSERT_TRUE(layout.crossed.shown());
  const pipeline::Image before = draw(view, live_status());
  view.a_scan = 80;
  const pipeline::Image after = draw(view, live_status());
  const Rect& crossed = layout.crossed.picture;
  EXPECT_GT(changed(before, after, crossed), crossed.width * crossed.height / 20);
  const Rect& fast = layout.b_scan.picture; // without the ends of the line at its borders
  EXPECT_EQ(changed(before, after, {fast.x, fast.y + 20, fast.width, fast.height - 40}), 0);
}

TEST_F(ScanMarks, missing_b_scans_stay_hatched_in_the_crossed_one) {
  auto volume = tissue_volume(small_geometry);
  mark_incomplete(volume);
  ASSERT_TRUE(renderer_->show_volume(volume));
  const pipeline::Image picture = draw(whole(LayoutKind::b_scan), live_status());
  const auto orange = [](const std::array<std::uint8_t, 3>& p) {
    return p[0] > p[2] + 20 && p[0] < 120;
  };
  const Rect& crossed = places(LayoutKind::b_scan).crossed.picture;
  const auto missing = std::ranges::find(volume.b_scan_states, pipeline::BScanState::missing) -
                       volume.b_scan_states.begin();
  EXPECT_GT(in_column(picture, crossed, (static_cast<double>(missing) + 0.5) / 40, orange),
            crossed.height / 4);
  EXPECT_LT(in_column(picture, crossed, 0.75, orange), crossed.height / 20);
}

TEST_F(ScanMarks, the_whole_scan_is_one_function_away) {
  auto volume = uniform_volume(small_geometry, 60);
  for (int b = 0; b < small_geometry.b_scans; ++b) // tissue in the lower third only
    for (int a = 0; a < small_geometry.a_scans; ++a)
      std::fill_n(volume.b_scan(b).begin() + a * small_geometry.depths + 80, 40, std::uint8_t{150});
  for (int i = 0; i < 25; ++i) // the cut waits, not to jump
    ASSERT_TRUE(renderer_->show_volume(volume));
  ViewState view = whole(LayoutKind::b_scan);
  const auto bright_share = [&] {
    const pipeline::Image picture = draw(view, live_status());
    const Rect frame = places(LayoutKind::b_scan).b_scan.frame;
    int bright = 0;
    int dark = 0;
    for (int y = frame.y + 40; y < frame.bottom(); ++y) { // a column left of the middle
      const auto p = picture.pixel(frame.x + frame.width * 2 / 5, y);
      bright += p[0] > 180 ? 1 : 0;
      dark += p[0] + p[1] + p[2] == 0 ? 1 : 0;
    }
    return static_cast<double>(bright) / std::max(bright + dark, 1);
  };
  EXPECT_NEAR(bright_share(), 40.0 / 128, 0.05);
  view.zoom_to_tissue = true;
  EXPECT_GT(bright_share(), 0.6) << "the empty part is not shown";
}

// The ruler's long ticks against the picture's physical height.
// As in the volume's picture: the bar's colour at a depth is that depth's.
TEST_F(ScanMarks, a_bar_says_which_colour_is_which_depth) {
  ViewState view = whole(LayoutKind::volume);
  const pipeline::Image grey = draw(view, live_status());
  view.colour_map = *TransferSet{}.colour_map_named("depth");
  const pipeline::Image coloured = draw(view, live_status());
  const Rect& bar_room = places(LayoutKind::volume).view;
  const int x = bar_room.x + 16 + 6;
  int found = 0;
  int last = -1;
  for (int y = bar_room.y; y < bar_room.bottom(); ++y) {
    const auto pixel = coloured.pixel(x, y);
    if (pixel == grey.pixel(x, y))
      continue;
    // The place whose tint this is.
    int nearest = 0;
    double least = 1e9;
    for (int place = 0; place <= 100; ++place) {
      const auto tint = depth_tint(static_cast<float>(place) / 100);
      double away = 0;
      for (std::size_t channel = 0; channel < 3; ++channel)
        away += std::abs(255.0 * static_cast<double>(tint[channel]) - pixel[channel]);
      if (away < least) {
        least = away;
        nearest = place;
      }
    }
    if (least > 12) // its dark border
      continue;
    EXPECT_GE(nearest, last) << "deeper downwards, at " << y;
    last = nearest;
    ++found;
  }
  EXPECT_GT(found, bar_room.height / 3);
  EXPECT_EQ(last, 99);
}

TEST_F(ScanMarks, the_rulers_ticks_are_round_lengths_apart) {
  ASSERT_TRUE(renderer_->show_volume(uniform_volume(small_geometry, 0)));
  const pipeline::Image picture = draw(whole(LayoutKind::b_scan), live_status());
  const Rect& b_scan = places(LayoutKind::b_scan).b_scan.picture;
  std::vector<double> ticks;
  for (int y = b_scan.y + 12; y < b_scan.bottom() - 12; ++y) {
    const auto lit = [&](int row) { return picture.pixel(b_scan.right() - 9, row)[1] > 120; };
    if (lit(y) && !lit(y - 1)) {
      int end = y;
      while (lit(end))
        ++end;
      ticks.push_back((y + end) / 2.0 - b_scan.y);
      y = end;
    }
  }
  ASSERT_GE(ticks.size(), 3U);
  const double mm_per_pixel = small_geometry.depth_mm() / b_scan.height;
  const double step_mm =
      (ticks.back() - ticks.front()) / static_cast<double>(ticks.size() - 1) * mm_per_pixel;
  EXPECT_NEAR(step_mm, round_ruler_step_mm(step_mm * 0.97), 0.02 * step_mm);
  for (const double tick : ticks)
    EXPECT_NEAR(tick * mm_per_pixel, std::round(tick * mm_per_pixel / step_mm) * step_mm,
                2 * mm_per_pixel);
  EXPECT_DOUBLE_EQ(round_ruler_step_mm(0.11), 0.2);
  EXPECT_DOUBLE_EQ(round_ruler_step_mm(0.06), 0.1);
  EXPECT_DOUBLE_EQ(round_ruler_step_mm(0.3), 0.5);
}

TEST_F(ScanMarks, the_calliper_crosses_its_voxels_and_says_the_distance) {
  ASSERT_TRUE(renderer_->show_volume(uniform_volume(small_geometry, 0)));
  ViewState view = whole(LayoutKind::b_scan);
  const pipeline::Image without = draw(view, live_status());
  view.calliper = true;
  view.mark_1_a = 30;
  view.mark_2_a = 60;
  view.mark_1_depth = 40;
  view.mark_2_depth = 90;
  const pipeline::Image with = draw(view, live_status());
  const Rect& b_scan = places(LayoutKind::b_scan).b_scan.picture;
  const auto yellow = [](const std::array<std::uint8_t, 3>& p) {
    return p[0] > 140 && p[1] > 130 && p[2] < p[1] - 40;
  };
  for (const auto& [a, depth] : {std::pair{30, 40}, {60, 90}}) {
    const int x = b_scan.x + static_cast<int>((a + 0.5) / 100 * b_scan.width);
    const int y = b_scan.y + static_cast<int>((depth + 0.5) / 128 * b_scan.height);
    int count = 0;
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx)
        count += yellow(with.pixel(x + dx, y + dy)) ? 1 : 0;
    EXPECT_GT(count, 3) << a;
  }
  const Rect said{b_scan.x, b_scan.y, b_scan.width / 2, 30};
  EXPECT_GT(changed(without, with, said), 200);
}

} // namespace
} // namespace octascope::tests
