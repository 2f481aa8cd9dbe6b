// The echo's words and the legend's picture.
#include <gtest/gtest.h>

#include "tests/ui/support/renderer_stage.h"
#include "ui/controls/built_in_profiles.h"
#include "ui/hud/echo.h"
#include "ui/hud/legend.h"
#include "ui/view/action_table.h"

namespace octascope::tests {
namespace {

using namespace ui;

ViewState echoing(Action action, std::string_view words, hal::TimePoint until) {
  ViewState view;
  view.echo = {action, false, {}, until};
  view.echo.words.format("{}", words);
  return view;
}

TEST(Echo, says_what_a_control_did) {
  const Status status = live_status();
  const hal::TimePoint later = status.now + std::chrono::seconds{1};
  ParameterEcho echo =
      compose_echo(echoing(Action::window_size, "", later), status.now, full_geometry);
  EXPECT_TRUE(echo.visible);
  EXPECT_EQ(echo.name, "Window size");
  EXPECT_EQ(echo.value.view(), "36 dB");
  EXPECT_TRUE(echo.ranged);
  EXPECT_NEAR(echo.share, 35.0 / 127, 1e-6);
  echo = compose_echo(echoing(Action::technique, "shaded rays", later), status.now, full_geometry);
  EXPECT_EQ(echo.name, "Technique");
  EXPECT_EQ(echo.value.view(), "shaded rays");
  EXPECT_FALSE(echo.ranged);
  EXPECT_FALSE(
      compose_echo(echoing(Action::technique, "rays", later), later, full_geometry).visible);
  for (const Action action : all_actions())
    if (number_of(action) != nullptr) {
      EXPECT_FALSE(
          compose_echo(echoing(action, "", later), status.now, full_geometry).value.empty());
    }
}

class LegendPicture : public RendererTest {
protected:
  void show(int width, int height) {
    open_renderer(width, height);
    show_scene();
  }
};

TEST_F(LegendPicture, stands_beside_the_volumes_centre_for_every_profile) {
  for (const auto& [width, height] : {std::pair{1280, 720}, {1024, 768}, {640, 360}}) {
    show(width, height);
    Status status = live_status();
    ViewState view;
    const pipeline::Image without = draw(view, status);
    view.legend_visible = true;
    const Layout layout = lay_out(width, height, {});
    const Rect centre{layout.view.width * 3 / 8, layout.view.height * 3 / 8, layout.view.width / 4,
                      layout.view.height / 4};
    const Rect side{layout.view.right(), 0, width - layout.view.right(), layout.view.height};
    for (const BuiltInProfile& built : built_in_profiles()) {
      const auto profile = built_in_profile(built.name);
      ASSERT_TRUE(profile);
      const Legend legend = built.name == "keyboard" ? make_key_legend() : make_legend(*profile);
      status.legend = &legend;
      const pipeline::Image with = draw(view, status);
      EXPECT_GT(changed(without, with, side), 2000) << built.name;
      EXPECT_EQ(changed(without, with, centre), 0) << built.name << " at " << width;
    }
  }
}

// Page after page, every line and the whole menu, in every size and layout.
TEST_F(LegendPicture, shows_everything_in_pages) {
  const auto profile = built_in_profile(default_profile);
  ASSERT_TRUE(profile);
  const Legend pedal = make_legend(*profile);
  EXPECT_EQ(pedal.menu, profile->menu);
  for (const auto& [width, height] : {std::pair{1280, 720}, {1024, 768}, {3840, 2160}}) {
    const auto fonts = Fonts::create(lay_out(width, height, {}).unit);
    ASSERT_TRUE(fonts) << fonts.error().message;
    Canvas canvas;
    for (const Legend& legend : {pedal, make_key_legend()})
      for (const LayoutKind kind :
           {LayoutKind::volume, LayoutKind::b_scan, LayoutKind::microscope, LayoutKind::quad}) {
        const Layout layout = lay_out(width, height, {}, kind, {.legend = true});
        const auto words_on = [&](std::int64_t page) {
          canvas.begin(*fonts, width, height);
          draw_legend(canvas, layout, legend, Action::tilt, page);
          return canvas.words().size();
        };
        // A title on each page, and its number where there are several.
        std::size_t words = words_on(0) - 1;
        std::int64_t pages = 1;
        const auto first = std::vector(canvas.words().begin(), canvas.words().end());
        const auto again = [&](std::int64_t page) {
          words_on(page);
          return std::ranges::equal(first, canvas.words(), {}, &Canvas::Words::rect,
                                    &Canvas::Words::rect);
        };
        for (; !again(pages) && pages < 9; ++pages)
          words += words_on(pages) - 1;
        words -= pages > 1 ? static_cast<std::size_t>(pages) : 0;
        EXPECT_LE(pages, 6) << width << ", kind " << static_cast<int>(kind);
        const std::size_t heading = legend.menu.empty() ? 0 : 1;
        EXPECT_EQ(words, 2 * legend.lines.size() + heading + legend.menu.size())
            << width << ", kind " << static_cast<int>(kind);
        for (const Canvas::Words& each : canvas.words())
          EXPECT_LE(each.rect.right(), layout.legend.right());
      }
  }
}

TEST_F(LegendPicture, is_drawn_when_asked_for_and_says_what_the_knob_turns) {
  const auto profile = built_in_profile(default_profile);
  ASSERT_TRUE(profile);
  const Legend legend = make_legend(*profile);
  Status status = live_status();
  status.legend = &legend;
  ViewState view;
  show(640, 360);
  const Rect whole{0, 0, 640, 360};
  const pipeline::Image hidden = draw(view, status);
  view.legend_visible = true;
  const pipeline::Image shown = draw(view, status);
  EXPECT_GT(changed(hidden, shown, whole), 2000);
  view.selected = Action::tilt;
  EXPECT_GT(changed(shown, draw(view, status), whole), 20);
  view.legend_visible = false;
  const pipeline::Image tilting = draw(view, status);
  view.legend_visible = view.legend_of_keys = true;
  EXPECT_EQ(changed(tilting, draw(view, status), whole), 0) << "there is none of keys";
}

} // namespace
} // namespace octascope::tests
