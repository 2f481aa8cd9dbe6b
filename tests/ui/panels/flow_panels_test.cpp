// What flows, in the flat pictures.
#include <array>
#include <cmath>
#include <random>

#include "pipeline/volume/flow_scale.h"
#include "tests/ui/support/gl_test.h"
#include "tests/ui/support/renderer_stage.h"
#include "tests/ui/support/synthetic_volume.h"
#include "ui/gl/picture_texture.h"
#include "ui/panels/b_scan_panel.h"
#include "ui/panels/en_face_panel.h"
#include "ui/panels/field_flow.h"
#include "ui/panels/flow_projection.h"
#include "ui/transfer/depth_colours.h"
#include "ui/transfer/flow_look.h"

namespace octascope::tests {
namespace {

using pipeline::FlowState;

constexpr int target_width = 640;
constexpr int target_height = 360;

using Pixel = std::array<std::uint8_t, 4>;

Pixel pixel_at(int x, int y) {
  Pixel rgba{};
  glReadPixels(x, target_height - 1 - y, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
  return rgba;
}

void expect_colour(const Pixel& pixel, const std::array<float, 3>& colour, int off = 2) {
  for (std::size_t i = 0; i < colour.size(); ++i)
    EXPECT_NEAR(pixel[i], 255 * std::clamp(colour[i], 0.0F, 1.0F), off) << i;
}

pipeline::Volume uniform_with_flow(const pipeline::VolumeGeometry& geometry) {
  pipeline::Volume volume = uniform_volume(geometry, 120);
  volume.add_flow();
  std::ranges::fill(volume.flow, pipeline::flow_static);
  std::ranges::fill(volume.flow_states, FlowState::told);
  return volume;
}

void leave_out(pipeline::Volume& volume, int b) {
  std::ranges::fill(volume.b_scan_flow(b), pipeline::flow_untold);
  volume.flow_states[static_cast<std::size_t>(b)] = FlowState::left_out;
}

ui::TissueMap tissue_in(const pipeline::Volume& volume) {
  pipeline::Occupancy occupancy{volume.geometry, pipeline::blank_depth_bins};
  occupancy.update(volume);
  ui::TissueMap tissue;
  tissue.update(occupancy, volume.b_scan_states);
  return tissue;
}

// Static tissue of 120 depths, from 80 on, in noise.
pipeline::Volume layered(const pipeline::VolumeGeometry& geometry) {
  pipeline::Volume volume = uniform_with_flow(geometry);
  std::minstd_rand random{7};
  for (std::size_t i = 0; i < volume.levels.size(); ++i)
    volume.levels[i] = static_cast<std::uint8_t>(
        i % static_cast<std::size_t>(geometry.depths) - 80 < 120 ? 140 : 60 + random() % 20);
  return volume;
}

void make_flow(pipeline::Volume& volume, int b, int a, std::array<int, 2> depths,
               std::uint8_t count) {
  for (int z = depths[0]; z < depths[1]; ++z)
    volume.b_scan_flow(b)[static_cast<std::size_t>(a * volume.geometry.depths + z)] = count;
}

class FlowPanelTest : public GlTest {
protected:
  void SetUp() override { open(target_width, target_height); }

  void draw_b_scan(const pipeline::Volume& volume, const ui::ViewState& view, const ui::Rect& rect,
                   ui::ScanDirection direction, bool shown = true) {
    ui::VolumeTexture texture;
    ASSERT_TRUE(texture.upload(volume));
    ui::StateTexture states;
    states.upload(volume);
    ui::FlowSections flow;
    flow.fetch(volume, view.b_scan, view.a_scan);
    auto panel = ui::BScanPanel::create();
    ASSERT_TRUE(panel) << panel.error().message;
    ASSERT_TRUE(panel->prepare_flow());
    panel->draw(texture, states, direction, view, {}, rect, target_height, shown ? &flow : nullptr);
  }
};

TEST_F(FlowPanelTest, a_b_scan_has_its_colours_where_it_flows_and_is_grey_elsewhere) {
  pipeline::Volume volume = uniform_with_flow({32, 16, 32, 1, 1, 1});
  make_flow(volume, 6, 11, {5, 6}, 255);
  make_flow(volume, 6, 3, {9, 10}, 128);
  ui::ViewState view;
  view.b_scan = 6;
  view.a_scan = 11;
  draw_b_scan(volume, view, {0, 0, 16, 32}, ui::ScanDirection::fast, false);
  const Pixel grey = pixel_at(0, 0);
  const float u = static_cast<float>(grey[0]) / 255;
  draw_b_scan(volume, view, {0, 0, 16, 32}, ui::ScanDirection::fast);
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 16; ++x) {
      const bool full = x == 11 && y == 5;
      const bool half = x == 3 && y == 9;
      const ui::TransferTable::Colour expected =
          ui::with_flow({u, u, u}, full   ? 1
                                   : half ? ui::flow_weight(128 / 255.0F)
                                          : 0);
      expect_colour(pixel_at(x, y), {expected.red, expected.green, expected.blue},
                    full || half ? 2 : 0);
    }
  draw_b_scan(volume, view, {0, 0, 32, 32}, ui::ScanDirection::slow);
  EXPECT_EQ(pixel_at(5, 5), grey);
  EXPECT_GT(pixel_at(6, 5)[0], pixel_at(6, 5)[2] + 100);
  EXPECT_EQ(pixel_at(7, 5), grey);
}

TEST_F(FlowPanelTest, what_could_not_be_told_is_marked_at_the_border_if_flow_is_shown) {
  pipeline::Volume volume = uniform_with_flow({32, 16, 8, 1, 1, 1});
  leave_out(volume, 3);
  const auto marked = [](int x, int y) { // lighter or darker than the tissue, in stripes
    int different = 0;
    for (int i = 0; i < 6; ++i)
      different += pixel_at(x + i, y) != pixel_at(x + i, 100) ? 1 : 0;
    return different > 0;
  };
  ui::ViewState view;
  view.b_scan = 3;
  view.a_scan = 8;
  const ui::Rect rect{0, 0, 80, 200};
  draw_b_scan(volume, view, rect, ui::ScanDirection::slow);
  EXPECT_TRUE(marked(32, 197));
  EXPECT_FALSE(marked(32, 185)) << "only at the lower border";
  EXPECT_FALSE(marked(22, 197)) << "the next B-scan";
  draw_b_scan(volume, view, rect, ui::ScanDirection::fast);
  EXPECT_TRUE(marked(2, 197));
  draw_b_scan(volume, view, rect, ui::ScanDirection::slow, false);
  EXPECT_FALSE(marked(32, 197));
}

TEST_F(FlowPanelTest, from_above_the_hue_is_the_depth_below_the_surface) {
  pipeline::Volume volume = layered({400, 96, 24, 5, 20, 80});
  for (int a = 8; a < 16; ++a)
    for (int b = 0; b < 24; ++b)
      make_flow(volume, b, a, {100, 110}, 255);
  for (int a = 24; a < 32; ++a)
    for (int b = 0; b < 24; ++b)
      make_flow(volume, b, a, {180, 190}, 255);
  leave_out(volume, 4);
  auto panel = ui::EnFacePanel::create();
  ASSERT_TRUE(panel) << panel.error().message;
  ASSERT_TRUE(panel->prepare_flow());
  const ui::TissueMap tissue = tissue_in(volume);
  panel->show(volume, tissue);
  ui::StateTexture states;
  states.upload(volume);
  const ui::Rect rect{0, 0, 480, 120}; // five pixels an A-scan and a B-scan
  panel->draw(states, {}, rect, target_height);
  const Pixel grey = pixel_at(300, 67);
  EXPECT_EQ(pixel_at(62, 67), grey) << "flow is not shown";
  panel->draw(states, {}, rect, target_height, 0.3F);
  const auto hue = [&](int depth) {
    const int below = depth + ui::flow_run / 2 - tissue.begin_of(13, 12).depth;
    return ui::depth_tint(static_cast<float>(below) / 400 / 0.3F);
  };
  EXPECT_NEAR(tissue.begin_of(13, 12).depth, 80, 8);
  expect_colour(pixel_at(62, 67), hue(100), 6);
  expect_colour(pixel_at(142, 67), hue(180), 6);
  EXPECT_NEAR(pixel_at(300, 67)[0], grey[0] / 2, 1) << "the grey makes room";
  EXPECT_EQ(pixel_at(300, 67)[0], pixel_at(300, 67)[2]);
  EXPECT_EQ(pixel_at(62, 22), pixel_at(300, 22)) << "not told there";
  bool marked = false;
  for (int x = 0; x < 12; ++x)
    marked = marked || pixel_at(x, 22) != pixel_at(x, 67);
  EXPECT_TRUE(marked);
  // While it is hidden nothing is projected.
  EXPECT_FALSE(panel->flow_from_above().empty());
  panel->show(volume, tissue, {}, nullptr, false);
  EXPECT_TRUE(panel->flow_from_above().empty());
  panel->draw(states, {}, rect, target_height, 0.3F);
  EXPECT_EQ(pixel_at(62, 67), grey);
  panel->show(volume, tissue);
  panel->draw(states, {}, rect, target_height, 0.3F);
  expect_colour(pixel_at(62, 67), hue(100), 6);
}

TEST(FlowProjection, is_the_strongest_run_of_depths) {
  pipeline::Volume volume = layered({413, 96, 24, 5, 20, 80}); // no whole number of blocks
  std::minstd_rand random{11};
  for (std::uint8_t& count : volume.flow)
    count = static_cast<std::uint8_t>(random() % 10 == 0 ? 1 + random() % 255 : random() % 90);
  const int least = ui::flow_run * (ui::first_seen_flow - 1); // below nothing is seen
  int seen = 0;
  const ui::TissueMap tissue = tissue_in(volume);
  std::vector<ui::FlowFromAbove> found(96 * 24);
  ui::project_flow(volume, tissue, found);
  for (int b = 0; b < 24; ++b)
    for (int a = 0; a < 96; ++a) {
      const auto counts = volume.b_scan_flow(b).subspan(static_cast<std::size_t>(a) * 413, 413);
      const int surface = tissue.begin_of(b, a).depth;
      ASSERT_NEAR(surface, 80, 8);
      int highest = 0;
      int at = surface;
      for (int from = surface; from + ui::flow_run <= 413; ++from) {
        int sum = 0;
        for (int i = 0; i < ui::flow_run; ++i)
          sum += counts[static_cast<std::size_t>(from + i)];
        if (sum > highest)
          at = from;
        highest = std::max(highest, sum);
      }
      const ui::FlowFromAbove& here = found[static_cast<std::size_t>(b * 96 + a)];
      if (highest <= least) {
        EXPECT_EQ(here, ui::FlowFromAbove{});
        continue;
      }
      ++seen;
      EXPECT_EQ(here.strength, (highest + ui::flow_run / 2) / ui::flow_run);
      EXPECT_NEAR(here.strength_by_depth, here.strength * (at + 2 - surface) / 413.0, 0.51);
    }
  EXPECT_GT(seen, 200);
  EXPECT_LT(seen, 96 * 24 - 200);
}

// A volume from the pipeline has them; another is searched whole.
TEST(FlowProjection, is_the_same_where_marks_say_where_to_look) {
  for (const int depths : {413, 416}) {
    pipeline::Volume volume = layered({depths, 95, 24, 5, 20, 80});
    std::minstd_rand random{12};
    for (std::uint8_t& count : volume.flow)
      count = static_cast<std::uint8_t>(random() % 1000 == 0 ? 255 : 127);
    const ui::TissueMap tissue = tissue_in(volume);
    std::vector<ui::FlowFromAbove> whole(95 * 24);
    ui::project_flow(volume, tissue, whole);
    volume.flow_marks = pipeline::FlowMarks{volume.geometry, pipeline::blank_depth_bins};
    for (int b = 0; b < 24; ++b)
      volume.flow_marks.update(b, volume.b_scan_flow(b));
    std::vector<ui::FlowFromAbove> marked(95 * 24);
    ui::project_flow(volume, tissue, marked);
    EXPECT_EQ(marked, whole);
    EXPECT_GT(std::ranges::count(whole, ui::FlowFromAbove{}), 500);
    EXPECT_LT(std::ranges::count(whole, ui::FlowFromAbove{}), 1800);
  }
}

// A fifth of the depths lies above the tissue.
TEST(FlowProjection, is_the_same_of_runs_found_while_the_volume_came) {
  pipeline::Volume volume = layered({413, 95, 24, 5, 20, 80});
  volume.metadata.index = 7;
  std::minstd_rand random{13};
  for (std::uint8_t& count : volume.flow)
    count = static_cast<std::uint8_t>(random() % 100 == 0 ? 255 : 110);
  volume.flow_marks = pipeline::FlowMarks{volume.geometry, pipeline::blank_depth_bins};
  for (int b = 0; b < 24; ++b)
    volume.flow_marks.update(b, volume.b_scan_flow(b));
  const ui::TissueMap tissue = tissue_in(volume);
  std::vector<ui::FlowFromAbove> whole(95 * 24);
  ui::project_flow(volume, tissue, whole);
  ui::ComingRuns coming;
  EXPECT_TRUE(coming.of(volume).empty());
  for (const int finished : {0, 3, 3, 17, 24}) {
    coming.bring(volume, 7, finished);
    const auto runs = coming.of(volume);
    ASSERT_EQ(std::ssize(runs), 95 * finished);
    std::vector<ui::FlowFromAbove> found(95 * 24);
    ui::project_flow(volume, tissue, found, {}, runs);
    EXPECT_EQ(found, whole);
  }
  int above = 0;
  for (std::size_t i = 0; i < whole.size(); ++i) {
    const auto [from, sum] = coming.of(volume)[i];
    above +=
        sum > 0 && from < tissue.begin_of(static_cast<int>(i / 95), static_cast<int>(i % 95)).depth;
  }
  EXPECT_GT(above, 100);
  volume.metadata.index = 8;
  EXPECT_TRUE(coming.of(volume).empty()) << "another one in the same memory";
}

TEST(FlowProjection, leaves_alone_what_is_not_wanted) {
  const pipeline::Volume volume = layered({400, 96, 24, 5, 20, 80});
  std::vector<ui::FlowFromAbove> out(96 * 24, ui::FlowFromAbove{9, 9});
  std::array<std::uint8_t, 24> wanted{};
  wanted[3] = 1;
  ui::project_flow(volume, tissue_in(volume), out, wanted);
  EXPECT_EQ(out[0], (ui::FlowFromAbove{9, 9}));
  EXPECT_EQ(out[3 * 96], ui::FlowFromAbove{});
}

std::vector<ui::FlowFromAbove> flow_at_depths(const std::vector<double>& shares) {
  std::vector<ui::FlowFromAbove> flow;
  for (const double share : shares)
    for (int i = 0; i < 50; ++i)
      flow.push_back({200, static_cast<std::uint8_t>(200 * share + 0.5)});
  flow.resize(4000); // nothing flows there
  return flow;
}

TEST(FlowDepths, reach_as_deep_as_what_flows_and_keep_their_scale) {
  ui::FlowDepths depths;
  depths.follow(flow_at_depths({}), 2);
  EXPECT_EQ(depths.deepest_mm(), 0);
  depths.follow(flow_at_depths({0.1, 0.15, 0.2}), 2); // 0.4 mm
  EXPECT_NEAR(depths.deepest_mm(), 0.5, 1e-9);
  depths.follow(flow_at_depths({0.1, 0.15, 0.3}), 2);
  EXPECT_NEAR(depths.deepest_mm(), 1, 1e-9) << "grows at once";
  std::vector<ui::FlowFromAbove> less = flow_at_depths({0.1, 0.15, 0.2});
  std::fill_n(less.end() - 4, 4, ui::FlowFromAbove{200, 80}); // of 154
  depths.follow(less, 2);
  EXPECT_NEAR(depths.deepest_mm(), 1, 1e-9) << "not for what flickers";
  depths.follow(flow_at_depths({0.1, 0.15, 0.2}), 2);
  EXPECT_NEAR(depths.deepest_mm(), 0.5, 1e-9);
  depths.follow(flow_at_depths({}), 2);
  EXPECT_NEAR(depths.deepest_mm(), 0.5, 1e-9);
  depths.follow(flow_at_depths({0.95}), 2);
  EXPECT_NEAR(depths.deepest_mm(), 2, 1e-9);
}

// Each texel of the projection lands where the field's corners say, as its outline does.
TEST_F(FlowPanelTest, lies_in_the_field_of_the_microscopes_picture) {
  std::vector<ui::FlowFromAbove> flow(10 * 10);
  flow[2 * 10 + 7] = {255, 0};
  ui::gl::Texture texture = ui::gl::make_picture_texture(GL_RG8, 10, 10);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, 10, 10, GL_RG, GL_UNSIGNED_BYTE, flow.data());
  const auto painter = ui::FieldFlow::create();
  ASSERT_TRUE(painter) << painter.error().message;
  const ui::Rect rect{20, 10, 500, 300};
  for (const ui::ScanField& field :
       {ui::ScanField{{{{0.2F, 0.1F}, {0.8F, 0.1F}, {0.8F, 0.9F}, {0.2F, 0.9F}}}},
        ui::ScanField{{{{0.8F, 0.2F}, {0.7F, 0.9F}, {0.1F, 0.8F}, {0.2F, 0.1F}}}},
        ui::ScanField{{{{0.1F, 0.1F}, {0.9F, 0.2F}, {0.7F, 0.9F}, {0.3F, 0.8F}}}}}) {
    glClearColor(0, 0, 0, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    painter->draw(texture, 1, field, rect, target_height);
    const auto place = [&](float across, float down) {
      const auto mix = [&](auto member) {
        const float top = std::lerp(field.corners[0].*member, field.corners[1].*member, across);
        const float bottom = std::lerp(field.corners[3].*member, field.corners[2].*member, across);
        return std::lerp(top, bottom, down);
      };
      return std::pair{rect.x + static_cast<int>(mix(&ui::ScanField::Corner::x) *
                                                 static_cast<float>(rect.width)),
                       rect.y + static_cast<int>(mix(&ui::ScanField::Corner::y) *
                                                 static_cast<float>(rect.height))};
    };
    const auto [x, y] = place(0.75F, 0.25F);
    EXPECT_GT(pixel_at(x, y)[0], 200);
    const ui::Rect inside = ui::around(field, rect);
    int lit = 0;
    double sum_x = 0;
    double sum_y = 0;
    for (int row = 0; row < target_height; ++row)
      for (int column = 0; column < target_width; ++column)
        if (pixel_at(column, row)[0] > 20) {
          ++lit;
          sum_x += column;
          sum_y += row;
          EXPECT_TRUE(inside.x <= column && column < inside.right() && inside.y <= row &&
                      row < inside.bottom());
        }
    EXPECT_NEAR(sum_x / lit, x, 2);
    EXPECT_NEAR(sum_y / lit, y, 2);
  }
}

class FlowDisplay : public RendererTest {
protected:
  void SetUp() override { open_renderer(1280, 720); }
  pipeline::Image drawn(const pipeline::Volume& volume, ui::VesselsShown shown,
                        const ui::Status& status = live_status()) {
    ui::ViewState view;
    view.vessels = shown;
    view.layout = ui::LayoutKind::microscope;
    renderer_->expect(view);
    show_scene(volume);
    return draw(view, status);
  }
  int different(const pipeline::Image& a, const pipeline::Image& b) {
    return changed(a, b, {0, 0, width_, height_});
  }
};

TEST_F(FlowDisplay, switched_off_is_the_picture_of_a_volume_without_flow) {
  const pipeline::Volume flowing = perfused_volume(small_geometry);
  pipeline::Volume without = flowing;
  without.flow.clear();
  without.flow_states.clear();
  const auto off = drawn(flowing, ui::VesselsShown::tree);
  const auto on = drawn(flowing, ui::VesselsShown::both);
  const auto none = drawn(without, ui::VesselsShown::both);
  EXPECT_EQ(different(off, none), 0);
  EXPECT_GT(different(on, none), 2000);
}

TEST_F(FlowDisplay, an_old_volumes_flow_is_not_over_a_live_microscope_picture) {
  const pipeline::Volume flowing = perfused_volume(small_geometry);
  ui::Status stale = live_status();
  stale.freshness = {ui::Liveness::stale, std::chrono::seconds{2}, {}};
  constexpr ui::Rect scope{250, 180, 350, 360}; // the middle of it
  const int live =
      changed(drawn(flowing, ui::VesselsShown::both), drawn(flowing, ui::VesselsShown::off), scope);
  const int old = changed(drawn(flowing, ui::VesselsShown::both, stale),
                          drawn(flowing, ui::VesselsShown::off, stale), scope);
  EXPECT_GT(live, 500);
  EXPECT_EQ(old, 0);
}

} // namespace
} // namespace octascope::tests
