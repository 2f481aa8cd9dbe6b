// Flow among the processor's rays: against double precision, and where there is none.
#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <gmock/gmock.h>
#include <hwy/highway.h>

#include "pipeline/volume/flow_scale.h"
#include "pipeline/volume/volume_geometry.h"
#include "tests/support/fails_with.h"
#include "tests/ui/support/instruction_sets.h"
#include "tests/ui/support/reference_rays.h"
#include "tests/ui/support/synthetic_volume.h"
#include "tests/ui/support/view_places.h"
#include "ui/ray_caster/ray_caster.h"
#include "ui/transfer/flow_look.h"
#include "ui/view/plane_box.h"

namespace octascope::tests {
namespace {

using ui::RayMode;

constexpr RayMode modes[] = {RayMode::composite, RayMode::shaded, RayMode::maximum};

class FlowRays : public testing::TestWithParam<std::string> {
protected:
  static constexpr int width = 61;
  static constexpr int height = 43;
  static constexpr float aspect = static_cast<float>(width) / height;

  void SetUp() override {
    auto made = ui::RayCaster::create(std::make_shared<ui::WorkTeam>(1, pipeline::ThreadSetup{}),
                                      GetParam());
    ASSERT_TRUE(made) << made.error().message;
    caster_ = std::make_unique<ui::RayCaster>(std::move(*made));
  }

  void show(const pipeline::Volume& volume) {
    pipeline::Occupancy levels{volume.geometry, pipeline::blank_depth_bins};
    levels.update(volume);
    pipeline::FlowMarks marks{volume.geometry, pipeline::blank_depth_bins};
    for (int b = 0; volume.has_flow() && b < volume.geometry.b_scans; ++b)
      marks.update(b, volume.b_scan_flow(b));
    const ui::FlowVoxels flow{volume.flow, &marks};
    ASSERT_TRUE(caster_->show(volume, levels, {}, volume.has_flow() ? &flow : nullptr));
    light_.show(volume);
  }

  ui::RaySettings settings(RayMode mode, const ui::ViewState& view, bool with_flow) {
    light_.prepare(ui::window_ramp(view));
    ui::RaySettings made{mode, glm::length(ui::box_extents_mm(caster_->geometry())) / 300, true};
    made.light = &light_;
    if (with_flow)
      made.flow_opacity = ui::flow_opacity(view.opacity);
    return made;
  }

  // For the view beside_flow().
  ui::RaySettings settings_beside_flow(const ui::ViewState& view) {
    ui::RaySettings made = settings(RayMode::composite, view, true);
    made.flow_opacity = ui::flow_opacity(0.5F);
    return made;
  }

  ui::RayImage cast(const ui::ViewState& view, const ui::RaySettings& how, bool as_table = false) {
    const auto table = std::make_unique<ui::TransferTable>();
    ui::make_window_table(view, *table);
    if (as_table)
      table->window.reset();
    caster_->set_transfer(*table);
    ui::RayImage image;
    image.resize(width, height);
    const auto drawn = caster_->draw(camera(view), how, image);
    EXPECT_TRUE(drawn) << drawn.error().message;
    return image;
  }

  ui::Camera camera(const ui::ViewState& view) const {
    return ui::make_camera(view, ui::box_extents_mm(caster_->geometry()), aspect);
  }

  std::unique_ptr<ui::RayCaster> caster_;
  ui::LightVolume light_;
};

INSTANTIATE_TEST_SUITE_P(Isas, FlowRays, testing::ValuesIn(instruction_sets()),
                         [](const auto& each) { return each.param; });

constexpr pipeline::VolumeGeometry tissue{70, 45, 21, 25.6, 66.7, 142.9};

int channel(std::uint32_t rgba, int which) {
  return static_cast<int>(rgba >> (8 * which) & 0xFFU);
}

// As a display shows it: tissue is glass.
ui::ViewState beside_flow(const Place& place) {
  return view_from(place, 0.5F * ui::tissue_beside_flow);
}

bool same_depth(float depth_mm, double expected_mm, float step_mm) {
  const double depth = static_cast<double>(depth_mm);
  return std::isinf(depth) ? std::isinf(expected_mm)
                           : std::abs(depth - expected_mm) < 1.5 * static_cast<double>(step_mm);
}

TEST_P(FlowRays, agree_with_double_precision_from_everywhere) {
  pipeline::Volume volume = tissue_volume(tissue);
  add_tubes(volume);
  show(volume);
  for (const RayMode mode : modes)
    for (const Place& place : places)
      for (const float opacity : {0.5F, 0.03F}) {
        const ui::ViewState view = view_from(place, opacity);
        const ui::RaySettings how = settings(mode, view, true);
        const ui::RayImage image = cast(view, how);
        const auto expected = reference_rays(volume, camera(view), view, how, width, height);
        double off[4] = {0, 0, 0, 0};
        double hue = 0;
        int deep = 0;
        for (std::size_t i = 0; i < expected.size(); ++i) {
          const auto& e = expected[i];
          const double should[4] = {e.grey, e.green, e.blue, e.opacity};
          for (int k = 0; k < 4; ++k)
            off[k] += std::abs(channel(image.rgba[i], k) - should[k]);
          hue += e.grey - e.blue;
          deep += same_depth(image.depth_mm[i], e.depth_mm, how.step_mm) ? 0 : 1;
        }
        const auto pixels = static_cast<double>(expected.size());
        const std::string where = std::string{place.name} + ", mode " +
                                  std::to_string(static_cast<int>(mode)) + ", opacity " +
                                  std::to_string(opacity);
        EXPECT_GT(hue / pixels, 0.1) << where << ": no flow is seen";
        for (const double each : off)
          EXPECT_LE(each / pixels, 0.6) << where;
        EXPECT_LE(deep / pixels, 0.03) << where;
      }
}

TEST_P(FlowRays, leaping_over_what_is_still_changes_not_one_bit) {
  // Nothing is visible but specks of flow, some on the bricks' sides.
  pipeline::Volume volume = uniform_volume({150, 90, 60, 20, 33, 50}, 0);
  volume.add_flow();
  for (int i = 0; i < 60; ++i)
    volume.b_scan_flow(i)[static_cast<std::size_t>((i * 37 % 90) * 150 + i * 53 % 150)] = 255;
  show(volume);
  for (const RayMode mode : modes)
    for (const Place& place : places) {
      const ui::ViewState view = view_from(place, 0.5F);
      ui::RaySettings how = settings(mode, view, true);
      const ui::RayImage leapt = cast(view, how);
      how.leap_empty = false;
      const ui::RayImage full = cast(view, how);
      EXPECT_EQ(leapt.rgba, full.rgba) << place.name;
      EXPECT_EQ(leapt.depth_mm, full.depth_mm) << place.name;
      EXPECT_TRUE(std::ranges::any_of(leapt.rgba, [](auto rgba) { return rgba != 0; }))
          << place.name;
    }
}

// Nor where tissue is sampled coarsely: there, which rays advance together changes with the leaps.
TEST_P(FlowRays, leaping_beside_coarse_tissue_changes_not_one_bit) {
  pipeline::Volume volume = tissue_volume(tissue);
  add_tubes(volume);
  show(volume);
  for (const Place& place : places) {
    const ui::ViewState view = beside_flow(place);
    ui::RaySettings how = settings_beside_flow(view);
    how.coarse_beside_flow = true;
    const ui::RayImage leapt = cast(view, how);
    how.leap_empty = false;
    const ui::RayImage full = cast(view, how);
    EXPECT_EQ(leapt.rgba, full.rgba) << place.name;
    EXPECT_EQ(leapt.depth_mm, full.depth_mm) << place.name;
    EXPECT_TRUE(std::ranges::any_of(leapt.rgba, [](auto rgba) { return rgba != 0; })) << place.name;
  }
}

TEST_P(FlowRays, of_what_is_static_or_hidden_are_those_of_the_levels) {
  pipeline::Volume volume = tissue_volume(tissue);
  const ui::ViewState view = view_from(places[0], 0.5F);
  const auto pictures = [&](bool with_flow) {
    std::vector<ui::RayImage> all;
    for (const RayMode mode : modes)
      for (const bool as_table : {false, true})
        all.push_back(cast(view, settings(mode, view, with_flow), as_table));
    return all;
  };
  const auto expect_same = [](const std::vector<ui::RayImage>& a,
                              const std::vector<ui::RayImage>& b) {
    for (std::size_t i = 0; i < a.size(); ++i) {
      EXPECT_EQ(a[i].rgba, b[i].rgba) << i;
      EXPECT_EQ(a[i].depth_mm, b[i].depth_mm) << i;
    }
  };
  show(volume);
  const auto plain = pictures(false);
  add_tubes(volume);
  show(volume);
  expect_same(pictures(false), plain);
  std::ranges::fill(volume.flow, static_cast<std::uint8_t>(ui::first_seen_flow - 1));
  show(volume);
  expect_same(pictures(true), plain);
}

// A layer as opaque as can be before it, or behind it.
TEST_P(FlowRays, are_veiled_by_what_lies_before) {
  pipeline::Volume volume = uniform_volume({64, 48, 48, 40, 40, 40}, 0);
  volume.add_flow();
  for (int b = 0; b < 48; ++b)
    for (int a = 0; a < 48; ++a)
      for (int z = 0; z < 64; ++z) {
        const auto at = static_cast<std::size_t>(a * 64 + z);
        volume.b_scan(b)[at] = z >= 10 && z < 16 ? 255 : 0;
        volume.b_scan_flow(b)[at] = z >= 30 && z < 40 ? 255 : 1;
      }
  show(volume);
  const auto middle = [&](float tilt) {
    const ui::ViewState view = view_from({"", 0, tilt, 3}, 1);
    return cast(view, settings(RayMode::composite, view, true)).rgba[21 * width + 30];
  };
  EXPECT_EQ(channel(middle(90), 0), channel(middle(90), 2)) << "nothing shines through";
  EXPECT_GT(channel(middle(-90), 0), 200);
  EXPECT_LT(channel(middle(-90), 2), 80);
}

// One sample for eight of the tissue: a little more grain, and nowhere brighter,
// darker or of another hue. What flows is as it was.
TEST_P(FlowRays, hardly_differ_where_tissue_beside_flow_is_sampled_coarsely) {
  pipeline::Volume volume = tissue_volume(tissue);
  add_tubes(volume);
  show(volume);
  for (const Place& place : places) {
    const ui::ViewState view = beside_flow(place);
    ui::RaySettings how = settings_beside_flow(view);
    how.soften = true;
    const ui::RayImage fine = cast(view, how);
    how.coarse_beside_flow = true;
    const ui::RayImage coarse = cast(view, how);
    EXPECT_NE(coarse.rgba, fine.rgba) << "it is another way";
    for (int k = 0; k < 4; ++k) {
      double sum = 0, square = 0;
      for (std::size_t i = 0; i < fine.rgba.size(); ++i) {
        const double off = channel(coarse.rgba[i], k) - channel(fine.rgba[i], k);
        sum += off;
        square += off * off;
      }
      const auto pixels = static_cast<double>(fine.rgba.size());
      EXPECT_LE(std::abs(sum / pixels), 0.5) << place.name << ", channel " << k;
      EXPECT_LE(std::sqrt(square / pixels), 3.5) << place.name << ", channel " << k;
    }
  }
}

TEST_P(FlowRays, need_flow_to_draw_it) {
  show(tissue_volume(tissue));
  const ui::ViewState view = view_from(places[0], 0.5F);
  ui::RayImage image;
  image.resize(8, 8);
  EXPECT_THAT(caster_->draw(camera(view), settings(RayMode::composite, view, true), image),
              FailsWith(hal::ErrorCode::invalid_argument));
}

} // namespace
} // namespace octascope::tests
