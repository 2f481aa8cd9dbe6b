// Bars of the timing diagram stand where their times are.
#include <array>
#include <chrono>

#include <gtest/gtest.h>

#include "tests/ui/support/renderer_stage.h"
#include "ui/hud/hud.h"

namespace octascope::tests {
namespace {

using namespace ui;
using std::chrono::milliseconds;

constexpr int screen_width = 1280;
constexpr int screen_height = 720;

class TimingDiagram : public RendererTest {
protected:
  void SetUp() override { open_renderer(screen_width, screen_height); }

  // A volume of 100 ms: the render thread works in the first half, the buffer holds it in the second.
  static TimedVolume volume(std::uint64_t index, hal::TimePoint begin) {
    const auto at = [&](int ms) { return begin + milliseconds{ms}; };
    return {index,
            at(0),
            at(100),
            {{at(0), at(50), TimingRow::render}, {at(50), at(100), TimingRow::buffer, true}}};
  }

  pipeline::Image draw_timing(const Timing& timing) {
    ViewState view;
    view.figures = FiguresShown::timing;
    Status status = live_status();
    status.timing = &timing;
    return draw(view, status);
  }

  static Rect room() {
    return lay_out(screen_width, screen_height, {}, LayoutKind::volume,
                   {.figures = true, .legend = false, .timing = true})
        .timing;
  }
  // The eighth parts from above: seven rows and the axis. The axis begins behind the rows' names.
  static Rect part_of_row(TimingRow row, double from, double to) {
    constexpr int names = 150;
    const Rect all = room();
    const int length = all.width - names;
    return {all.x + names + static_cast<int>(from * length),
            all.y + all.height * static_cast<int>(row) / 8, static_cast<int>((to - from) * length),
            all.height / 8};
  }
};

TEST_F(TimingDiagram, bars_stand_in_their_rows_at_their_times) {
  Timing timing;
  timing.newest = 3;
  timing.volumes[0] = volume(3, hal::TimePoint{milliseconds{1000}});
  const pipeline::Image picture = draw_timing(timing);
  const auto filled = [&](TimingRow row, double from, double to) {
    const Rect where = part_of_row(row, from, to);
    return count_colour(picture, where, palette::accent) /
           static_cast<double>(where.width * where.height);
  };
  EXPECT_GT(filled(TimingRow::render, 0.1, 0.4), 0.6) << "works";
  EXPECT_EQ(filled(TimingRow::render, 0.6, 0.9), 0);
  EXPECT_EQ(filled(TimingRow::buffer, 0.1, 0.4), 0);
  const double waits = filled(TimingRow::buffer, 0.6, 0.9);
  EXPECT_GT(waits, 0.05) << "framed";
  EXPECT_LT(waits, 0.3);
  EXPECT_EQ(filled(TimingRow::workers, 0, 1), 0);
}

TEST_F(TimingDiagram, three_volumes_have_colours_of_their_own_and_share_the_axis) {
  Timing timing;
  timing.newest = 9;
  for (std::uint64_t i = 0; i < 3; ++i)
    timing.volumes[i] = // of which others were skipped between
        volume(3 + 3 * i, hal::TimePoint{milliseconds{1000 + 100 * static_cast<int>(i)}});
  const pipeline::Image picture = draw_timing(timing);
  const std::array colours{palette::accent, palette::crossed, palette::calliper};
  for (std::size_t i = 0; i < colours.size(); ++i)
    for (std::size_t third = 0; third < 3; ++third) {
      const double from = static_cast<double>(third) / 3;
      const Rect where = part_of_row(TimingRow::render, from + 0.05, from + 0.12);
      EXPECT_EQ(count_colour(picture, where, colours[i]) > where.width * where.height / 2,
                i == third);
    }
}

TEST_F(TimingDiagram, leaves_out_what_was_long_before) {
  Timing timing;
  timing.newest = 3;
  timing.volumes[0] = volume(3, hal::TimePoint{milliseconds{60'000}});
  const pipeline::Image alone = draw_timing(timing);
  timing.volumes[1] = volume(2, hal::TimePoint{milliseconds{1000}}); // frozen meanwhile
  EXPECT_EQ(changed(alone, draw_timing(timing), room()), 0);
  timing.volumes[1] = volume(2, hal::TimePoint{milliseconds{59'800}});
  EXPECT_GT(changed(alone, draw_timing(timing), room()), 1000);
}

TEST_F(TimingDiagram, is_drawn_on_request_alone_and_anew_with_every_volume) {
  Timing timing;
  const pipeline::Image none = draw_timing(timing);
  timing.newest = 3;
  timing.volumes[0] = volume(3, hal::TimePoint{milliseconds{1000}});
  EXPECT_GT(changed(none, draw_timing(timing), room()), 1000);
  Status status = live_status();
  status.timing = &timing;
  ViewState view;
  view.figures = FiguresShown::strip;
  const pipeline::Image strip = draw(view, status);
  EXPECT_EQ(count_colour(strip, part_of_row(TimingRow::render, 0.1, 0.4), palette::accent), 0);
}

} // namespace
} // namespace octascope::tests
