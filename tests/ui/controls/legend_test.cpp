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

TEST_F(LegendPicture, says_what_does_not_fit) {
  show(640, 360);
  Legend legend{"A device of forty buttons", {}};
  for (int i = 0; i < 12; ++i)
    legend.lines.push_back({"Button", Action::freeze, false});
  Status status = live_status();
  status.legend = &legend;
  ViewState view;
  view.legend_visible = true;
  const auto orange = [&] {
    const pipeline::Image picture = draw(view, status);
    int count = 0;
    for (int y = 0; y < 320; ++y)
      for (int x = 440; x < 640; ++x)
        count += picture.pixel(x, y)[0] > 2 * picture.pixel(x, y)[2] + 40;
    return count;
  };
  EXPECT_EQ(orange(), 0);
  legend.lines.resize(40, legend.lines.front());
  EXPECT_GT(orange(), 10);
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
  view.legend_of_keys = true;
  EXPECT_EQ(changed(hidden, draw(view, status), whole), 0) << "there is none of keys";
}

} // namespace
} // namespace octascope::tests
