// The display in every size that a window can have, with everything on it that can be.
#include <array>
#include <bitset>
#include <cmath>

#include <imgui.h>

#include "tests/support/fails_with.h"
#include "tests/ui/support/renderer_stage.h"
#include "ui/controls/legend_lines.h"
#include "ui/hud/hud.h"

namespace octascope::tests {
namespace {

using namespace ui;

constexpr std::array every_kind{LayoutKind::volume, LayoutKind::b_scan, LayoutKind::microscope,
                                LayoutKind::quad};
constexpr std::array stereo_modes{StereoMode::off, StereoMode::side_by_side,
                                  StereoMode::top_bottom};

class EverySize : public RendererTest {
protected:
  static constexpr int frame = 512; // of which the lower left corner is drawn

  void SetUp() override {
    open_renderer(frame, frame);
    if (!IsSkipped())
      show_scene();
  }

  // What GL left outside of the size that was asked for.
  int strange_pixels(int width, int height) const {
    const pipeline::Image all = renderer_->read_back(frame, frame);
    const auto ground =
        std::array{palette::background.r, palette::background.g, palette::background.b};
    int count = 0;
    for (int y = 0; y < frame; ++y)
      for (int x = y < frame - height ? 0 : width; x < frame; ++x)
        count += all.pixel(x, y) != ground ? 1 : 0;
    return count;
  }
};

TEST_F(EverySize, is_drawn_with_everything_on_it_and_nothing_beside_it) {
  const Legend keys = make_key_legend();
  Status live = worst_status();
  live.key_legend = &keys;
  Timing timing;
  timing.newest = 1;
  timing.volumes[0] = {1,
                       live.now,
                       live.now + std::chrono::milliseconds{40},
                       {{live.now - std::chrono::milliseconds{140},
                         live.now + std::chrono::milliseconds{40}, TimingRow::render}}};
  live.timing = &timing;
  Status replayed = live;
  replayed.replay = ReplayStatus{.recorded = "2026-11-22 12:10:03"};
  replayed.recording = {};
  ViewState view;
  view.legend_visible = view.legend_of_keys = view.vessel_account = true;
  view.figures = FiguresShown::timing;
  view.echo = {Action::window_size, true, {}, live.now + std::chrono::seconds{1}};
  for (const auto& [width, height] : {std::pair{1, 1},
                                      {2, 2},
                                      {1, 512},
                                      {512, 1},
                                      {17, 31},
                                      {100, 60},
                                      {180, 320},
                                      {300, 200},
                                      {399, 300},
                                      {400, 300},
                                      {512, 512}})
    for (const Status* status : {&live, &replayed})
      for (const LayoutKind kind : every_kind)
        for (const StereoMode stereo : stereo_modes) {
          SCOPED_TRACE(testing::Message()
                       << width << "x" << height << ", kind " << static_cast<int>(kind)
                       << ", stereo " << static_cast<int>(stereo));
          view.layout = kind;
          view.stereo = stereo;
          const auto drawn =
              renderer_->draw(view, *status, width, height, {.resolution = 0.25F, .steps = 64});
          ASSERT_TRUE(drawn) << drawn.error().message;
          ASSERT_EQ(strange_pixels(width, height), 0);
          ASSERT_EQ(glGetError(), GLenum{GL_NO_ERROR});
        }
}

// A replay has no figure of lines: whichever are there, the strip measures no other.
TEST_F(EverySize, the_engineers_strip_holds_any_of_its_figures) {
  ViewState view;
  view.figures = FiguresShown::strip;
  const HudText full = compose_hud_text(view, worst_status(), {});
  constexpr std::size_t figure_count = std::tuple_size_v<decltype(HudText::figures)>;
  for (const auto& [width, height] : {std::pair{1, 1}, {200, 300}, {640, 360}, {1280, 720}}) {
    const Layout layout = lay_out(width, height, {}, LayoutKind::volume, {.figures = true});
    const auto fonts = Fonts::create(layout.unit);
    ASSERT_TRUE(fonts) << fonts.error().message;
    Canvas canvas;
    for (unsigned there = 0; there < 1U << figure_count; ++there) {
      HudText text = full;
      for (std::size_t i = 0; i < figure_count; ++i)
        if (std::bitset<figure_count>{there}[i])
          text.figures[i].label = "Label";
        else
          text.figures[i] = {};
      canvas.begin(*fonts, width, height);
      draw_engineers_strip(canvas, layout, text);
      if (width > 1) { // newer ImGui draws no dot of less than half a pixel
        ASSERT_GT(canvas.list().VtxBuffer.Size, 0) << "the devices at least";
      }
    }
  }
}

TEST_F(EverySize, letters_have_a_largest_size_and_are_refused_beyond_it) {
  const Layout largest = lay_out(16384, 16384, {});
  EXPECT_EQ(largest.unit, largest_unit);
  const auto fonts = Fonts::create(largest.unit);
  ASSERT_TRUE(fonts) << fonts.error().message;
  GLint side = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &side);
  EXPECT_LE(fonts->atlas().TexHeight, side);
  for (int i = 0; i < text_style_count; ++i) // none is past the builder's buffer
    for (const ImFontGlyph& glyph : fonts->font(static_cast<TextStyle>(i)).Glyphs)
      EXPECT_LE((glyph.X1 - glyph.X0) * (glyph.Y1 - glyph.Y0), 65536) << glyph.Codepoint;
  for (const float unit : {0.0F, -1.0F, largest_unit * 1.01F, 11.1F, NAN})
    EXPECT_THAT(Fonts::create(unit), FailsWith(hal::ErrorCode::invalid_argument)) << unit;
}

} // namespace
} // namespace octascope::tests
