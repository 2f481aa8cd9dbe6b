// What is read from two metres: how large letters are, whose alphabets there are, that nothing lies
// over anything else, and contrast; in every layout, size and state.
#include <algorithm>
#include <array>
#include <map>
#include <span>
#include <string>
#include <vector>

#include <GLES3/gl3.h>
#include <fmt/format.h>
#include <imgui.h>

#include "tests/ui/support/gl_test.h"
#include "tests/ui/support/scene.h"
#include "tests/ui/support/synthetic_volume.h"
#include "ui/canvas/canvas_renderer.h"
#include "ui/controls/built_in_profiles.h"
#include "ui/controls/legend_lines.h"
#include "ui/gl/framebuffer.h"
#include "ui/hud/hud.h"
#include "ui/layout/stereo.h"

namespace octascope::tests {
namespace {

using namespace ui;

// Big-endian numbers of an OpenType file's tables (the OpenType specification, 1.9).
class FontTables {
public:
  explicit FontTables(std::span<const unsigned char> file) : file_{file} {}

  int number(std::string_view table, std::size_t at) const {
    const std::size_t count = u16(4);
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t entry = 12 + 16 * i;
      if (std::string_view{reinterpret_cast<const char*>(&file_[entry]), 4} == table)
        return static_cast<std::int16_t>(u16((u16(entry + 8) << 16U | u16(entry + 10)) + at));
    }
    ADD_FAILURE() << "no table " << table;
    return 0;
  }
  // Height of capitals as a share of a line from ascender to descender.
  double capital_share() const {
    return number("OS/2", 88) / static_cast<double>(number("hhea", 4) - number("hhea", 6));
  }

private:
  std::size_t u16(std::size_t at) const {
    return static_cast<std::size_t>(file_[at]) << 8U | file_[at + 1];
  }
  std::span<const unsigned char> file_;
};

std::span<const unsigned char> file_of(TextStyle style) {
  return style == TextStyle::label ? inter().medium : inter().semi_bold;
}

double arcmin(double mm) {
  return std::atan(mm / viewing_distance_mm) * 180 * 60 / 3.14159265358979;
}

// Every height up to that of the largest letters, at the aspects of monitors; those of 5:4 and 4:3
// from as wide a picture on.
TEST(GlanceLetters, are_as_high_as_two_metres_need_in_every_size) {
  EXPECT_NEAR(mm_per_pixel(1920, 1080) * 1920, 597.7, 0.3);
  EXPECT_NEAR(mm_per_pixel(1024, 768) * 1024, 548.6, 0.3) << "4:3 of the same diagonal";
  EXPECT_NEAR(mm_per_pixel(3440, 1440) * 1440, 336.2, 0.3) << "as high as 16:9";
  for (const double aspect : {5.0 / 4, 4.0 / 3, 1.5, 1.6, 16.0 / 9, 43.0 / 18})
    for (int height = 720; height <= 4320; ++height) {
      const int width = static_cast<int>(std::lround(height * aspect));
      const float unit = lay_out(width, height, {}).unit;
      for (int i = 0; i < text_style_count; ++i) {
        const auto style = static_cast<TextStyle>(i);
        const double cap_pixels = static_cast<double>(line_pixels(style, unit)) *
                                  FontTables{file_of(style)}.capital_share();
        ASSERT_GE(arcmin(cap_pixels * mm_per_pixel(width, height)),
                  style == TextStyle::badge ? glance_arcmin : lookup_arcmin)
            << width << "x" << height << ", style " << i;
      }
    }
}

class Glance : public GlTest {};

// What is drawn is what was computed; hinting rounds to whole pixels.
TEST_F(Glance, letters_are_drawn_as_high_as_computed) {
  for (const float unit : {0.89F, 1.0F, 1.5F, 3.0F}) {
    const auto fonts = Fonts::create(unit);
    ASSERT_TRUE(fonts) << fonts.error().message;
    for (int i = 0; i < text_style_count; ++i) {
      const auto style = static_cast<TextStyle>(i);
      const ImFontGlyph* glyph = fonts->font(style).FindGlyph('H');
      EXPECT_NEAR(glyph->Y1 - glyph->Y0,
                  static_cast<double>(line_pixels(style, unit)) *
                      FontTables{file_of(style)}.capital_share(),
                  1.01)
          << unit << ", style " << i;
    }
  }
}

// Names come from outside: subjects, files, devices, axes.
TEST_F(Glance, latin_greek_and_cyrillic_names_are_drawn_and_others_marked) {
  const auto fonts = Fonts::create(1);
  ASSERT_TRUE(fonts) << fonts.error().message;
  const std::u32string_view drawn =
      U"Łódź Ångström Çelik Çağlar Őry Ștefan Žižek Æsøe Ñandú İnci Ğ "
      U"Ωμέγα Ψυχή ΐΰ Άννα Юрій Щербак Ёлка Ґанна Ћирић Љубав Њ";
  const std::u32string_view others = U"名前かな한국어שםاسم";
  for (const TextStyle style : {TextStyle::label, TextStyle::value}) {
    const ImFont& font = fonts->font(style);
    for (const char32_t letter : drawn)
      EXPECT_NE(font.FindGlyphNoFallback(static_cast<ImWchar>(letter)), nullptr)
          << "U+" << fmt::format("{:04X}", static_cast<unsigned>(letter));
    const ImFontGlyph* mark = font.FindGlyphNoFallback(0x25A1);
    ASSERT_NE(mark, nullptr);
    EXPECT_GT(mark->X1 - mark->X0, 5) << "it can be seen";
    for (const char32_t letter : others)
      EXPECT_EQ(font.FindGlyph(static_cast<ImWchar>(letter)), mark);
  }
}

constexpr std::array glance_sizes{
    std::pair{1280, 720},  std::pair{1920, 1080}, std::pair{3840, 2160}, std::pair{1024, 768},
    std::pair{1600, 1200}, std::pair{1280, 1024}, std::pair{2560, 1600}, std::pair{3440, 1440}};
constexpr std::array glance_kinds{LayoutKind::volume, LayoutKind::b_scan, LayoutKind::microscope,
                                  LayoutKind::quad};

bool inks_overlap(const Rect& a, const Rect& b) {
  return !a.empty() && !b.empty() && a.x < b.right() && b.x < a.right() && a.y < b.bottom() &&
         b.y < a.bottom();
}

bool lies_within(const Rect& inner, const Rect& outer) {
  return inner.x >= outer.x && inner.y >= outer.y && inner.right() <= outer.right() &&
         inner.bottom() <= outer.bottom();
}

Rect middle_half(const Rect& rect) {
  return {rect.x + (rect.width + 3) / 4, rect.y + (rect.height + 3) / 4, rect.width / 2 - 1,
          rect.height / 2 - 1};
}

// From the top of capitals to the base line, roughly: what a letter's line has above and below may
// meet its neighbour's.
Rect ink_of(const Canvas::Words& words) {
  const int spare = words.rect.height / 6;
  return {words.rect.x, words.rect.y + spare, words.rect.width, words.rect.height - 2 * spare};
}

struct State {
  std::string name;
  ViewState view;
  Status status;
  FlowShown flow{};
};

std::vector<State> glance_states(const Legend& pedal, const Legend& keys) {
  std::vector<State> all;
  Status live = live_status();
  live.legend = &pedal;
  live.key_legend = &keys;
  Status worst = worst_status();
  worst.legend = &pedal;
  worst.key_legend = &keys;
  for (std::size_t i = 0; i < worst.device_count; ++i)
    worst.devices[i].state = i % 2 == 0 ? hal::DeviceState::failed : hal::DeviceState::absent;
  worst.subject = "Константинополь, Ωμέγα…";
  ViewState view;
  ViewState chosen;
  chosen.selected = Action::keep_registration;
  chosen.echo = {Action::keep_registration, true, {}, live.now + std::chrono::seconds{1}};
  chosen.echo.words.format("turn right to do it");
  ViewState turned;
  turned.echo = {Action::window_offset, false, {}, live.now + std::chrono::seconds{1}};
  ViewState strip;
  strip.figures = FiguresShown::strip;
  ViewState legend;
  legend.legend_visible = true;
  ViewState key_legend = legend;
  key_legend.legend_of_keys = true;
  all.push_back({"live", view, live});
  all.push_back({"worst", chosen, worst});
  all.push_back({"turned", turned, live});
  all.push_back({"strip", strip, live});
  all.push_back({"strip, worst", strip, worst});
  all.push_back({"legend", legend, worst});
  all.push_back({"keys", key_legend, live});
  Status replay = worst;
  replay.recording = {};
  replay.replay = ReplayStatus{.recorded = "2026-11-22 12:10:03"};
  replay.freshness = {Liveness::frozen, std::chrono::seconds{3599}, std::chrono::seconds{3599}};
  all.push_back({"replay", view, replay});
  Status eye = live;
  eye.eye = pipeline::Eye::left;
  eye.orientation.on_eye = {Side::temporal, Side::inferior};
  all.push_back({"eye", view, eye});
  eye.notice =
      "Not taken over: octascope.toml:12: [scan] samples is 1023, expected a multiple of 8 "
      "for this camera";
  eye.vessels.registered = true;
  eye.vessels.state = VesselStatus::State::shown;
  eye.vessels.branches = {true, true, true, true};
  eye.vessels.account = {1'234'567, 1'234'567, 1'234'567, 1'234'567};
  ViewState vessels;
  vessels.vessel_account = true;
  all.push_back({"vessels", vessels, eye});
  const FlowShown flow{.shown = true,
                       .b_scan = pipeline::FlowState::left_out,
                       .told = 33,
                       .left_out = 47,
                       .deepest_mm = 1.2,
                       .in_scope = true};
  all.push_back({"flow", strip, live, flow});
  all.push_back({"flow and vessels", vessels, eye, flow});
  Status traced = live;
  traced.vessels.state = VesselStatus::State::shown;
  traced.vessels.registered = true;
  traced.vessels.traced = TracedTreeStatus{.state = TracedTreeStatus::State::shown,
                                           .age = std::chrono::seconds{9},
                                           .vessels = 1234,
                                           .length_mm = 987.6,
                                           .refusal = {}};
  all.push_back({"traced", view, traced});
  traced.vessels.state = VesselStatus::State::none;
  traced.vessels.traced->state = TracedTreeStatus::State::refused;
  traced.vessels.traced->refusal =
      "what flows stands out by 40 % from what does not, expected 70 %";
  all.push_back({"refused", view, traced});
  Status scale = live;
  scale.configuration = ConfigurationState::built_in;
  scale.another_camera = true;
  scale.missing_b_scans = 80;
  scale.saturated_lines = 23'456;
  all.push_back({"small badges", view, scale});
  return all;
}

// One picture's heads-up display, without the pictures.
struct Drawn {
  Layout layout;
  HudText text;
  Canvas ground{};
  Canvas overlay{};
  std::vector<Rect> pictures{}; // the view first
  std::vector<Rect> badges{};
};

void draw(Drawn& drawn, const Fonts& fonts, const State& state, int width, int height) {
  HudScene scene;
  scene.shown.volume = scene.shown.scope = true;
  scene.shown.geometry = small_geometry;
  scene.shown.geometry.refractive_index = 1.38;
  scene.shown.scope_time = state.status.now;
  scene.shown.flow = state.flow;
  scene.shown.b_scan =
      state.status.missing_b_scans > 0 ? pipeline::BScanState::missing : pipeline::BScanState::good;
  scene.extents_mm = box_extents_mm(small_geometry);
  scene.scan_field = ScopePicture{4, 3}.field();
  scene.depth_colours = DepthColours{0.1F, 0.8F};
  const LevelShares levels{};
  scene.levels = &levels;
  drawn.text = compose_hud_text(state.view, state.status, scene.shown);
  drawn.layout = lay_out(width, height, {1.67, 1, 4.0 / 3}, state.view.layout,
                         {drawn.text.figures_shown, drawn.text.legend != nullptr});
  if (!drawn.layout.view.empty())
    scene.camera = make_camera(state.view, scene.extents_mm,
                               static_cast<float>(drawn.layout.view.width) /
                                   static_cast<float>(drawn.layout.view.height));
  drawn.ground.begin(fonts, width, height);
  draw_hud_ground(drawn.ground, drawn.layout);
  draw_view_ground(drawn.ground, drawn.layout);
  drawn.overlay.begin(fonts, width, height);
  draw_hud(drawn.overlay, drawn.layout, drawn.text, state.view, scene);
  drawn.pictures.clear();
  for (const Rect& picture :
       {drawn.layout.view, drawn.layout.b_scan.picture, drawn.layout.crossed.picture,
        drawn.layout.en_face.picture, drawn.layout.scope.picture})
    if (!picture.empty())
      drawn.pictures.push_back(picture);
  drawn.badges.clear();
  const BadgePlaces places = place_badges(drawn.overlay, drawn.layout, drawn.text);
  for (std::size_t i = 0; i < drawn.text.badge_count; ++i)
    if (!places[i].empty())
      drawn.badges.push_back(places[i]);
}

void expect_room(const Drawn& drawn, int width, int height) {
  const auto words = drawn.overlay.words();
  ASSERT_GT(words.size(), 5U);
  for (std::size_t i = 0; i < words.size(); ++i) {
    const Rect ink = ink_of(words[i]);
    EXPECT_TRUE(lies_within(words[i].rect, {0, 0, width, height})) << "words " << i;
    for (std::size_t k = i + 1; k < words.size(); ++k)
      EXPECT_FALSE(inks_overlap(ink, ink_of(words[k])))
          << "words " << i << " and " << k << " at " << ink.x << ", " << ink.y << " and "
          << words[k].rect.x << ", " << words[k].rect.y;
    for (const Rect& badge : drawn.badges)
      EXPECT_TRUE(!inks_overlap(ink, badge) || lies_within(ink, badge))
          << "words " << i << " and a badge";
    for (const Rect& picture : drawn.pictures) {
      EXPECT_FALSE(inks_overlap(ink, middle_half(picture)))
          << "words " << i << " at " << ink.x << ", " << ink.y;
      EXPECT_TRUE(!inks_overlap(ink, picture) || lies_within(ink, picture))
          << "words " << i << " across a border at " << ink.x << ", " << ink.y;
    }
  }
  for (std::size_t i = 0; i < drawn.badges.size(); ++i) {
    for (std::size_t k = i + 1; k < drawn.badges.size(); ++k)
      EXPECT_FALSE(inks_overlap(drawn.badges[i], drawn.badges[k]))
          << "badges " << i << " and " << k;
    for (const Rect& picture : drawn.pictures)
      EXPECT_FALSE(inks_overlap(drawn.badges[i], middle_half(picture))) << "badge " << i;
  }
}

TEST_F(Glance, nothing_lies_over_anything_else_nor_over_a_pictures_middle) {
  const auto profile = built_in_profile(default_profile);
  ASSERT_TRUE(profile);
  const Legend pedal = make_legend(*profile);
  const Legend keys = make_key_legend();
  for (const auto& [width, height] : glance_sizes) {
    const auto fonts = Fonts::create(lay_out(width, height, {}).unit);
    ASSERT_TRUE(fonts) << fonts.error().message;
    for (State& state : glance_states(pedal, keys))
      for (const LayoutKind kind : glance_kinds) {
        SCOPED_TRACE(testing::Message() << width << "x" << height << ", " << state.name << ", kind "
                                        << static_cast<int>(kind));
        state.view.layout = kind;
        Drawn drawn;
        draw(drawn, *fonts, state, width, height);
        expect_room(drawn, width, height);
      }
  }
}

// What most of a rectangle's pixels are.
ui::Colour ground_in(const pipeline::Image& image, const Rect& rect) {
  std::map<std::array<std::uint8_t, 3>, int> counts;
  for (int y = rect.y; y < rect.bottom(); ++y)
    for (int x = rect.x; x < rect.right(); ++x)
      ++counts[image.pixel(x, y)];
  const auto most =
      std::ranges::max_element(counts, {}, [](const auto& each) { return each.second; });
  return {most->first[0], most->first[1], most->first[2]};
}

// Over the brightest picture and over the darkest. Words with an outline have their ground with
// them.
TEST_F(Glance, every_word_has_contrast_over_any_picture) {
  const auto profile = built_in_profile(default_profile);
  ASSERT_TRUE(profile);
  const Legend pedal = make_legend(*profile);
  const Legend keys = make_key_legend();
  for (const auto& [width, height] : {std::pair{1280, 720}, {1024, 768}}) {
    open(width, height);
    const auto fonts = Fonts::create(lay_out(width, height, {}).unit);
    ASSERT_TRUE(fonts) << fonts.error().message;
    auto renderer = CanvasRenderer::create();
    ASSERT_TRUE(renderer);
    for (State& state : glance_states(pedal, keys))
      for (const LayoutKind kind : glance_kinds)
        for (const float picture : {0.0F, 1.0F}) {
          SCOPED_TRACE(testing::Message() << width << "x" << height << ", " << state.name
                                          << ", kind " << static_cast<int>(kind));
          state.view.layout = kind;
          Drawn drawn;
          draw(drawn, *fonts, state, width, height);
          glClearColor(picture, picture, picture, 1);
          glClear(GL_COLOR_BUFFER_BIT);
          const EyeFrame frame = eye_frame(StereoMode::off, StereoEye::centre, width, height);
          renderer->draw(drawn.ground, frame, height);
          for (const Rect& each : drawn.pictures) {
            glEnable(GL_SCISSOR_TEST);
            glScissor(each.x, height - each.bottom(), each.width, each.height);
            glClear(GL_COLOR_BUFFER_BIT);
            glDisable(GL_SCISSOR_TEST);
          }
          renderer->draw(drawn.overlay, frame, height);
          const pipeline::Image image = gl::read_framebuffer(width, height);
          for (const Canvas::Words& words : drawn.overlay.words()) {
            const ui::Colour ground = words.shadowed ? palette::ink : ground_in(image, words.rect);
            EXPECT_GE(contrast(words.colour, ground), 6.9)
                << "at " << words.rect.x << ", " << words.rect.y;
          }
        }
  }
}

} // namespace
} // namespace octascope::tests
