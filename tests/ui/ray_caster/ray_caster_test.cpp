// The processor's ray caster against a slow one in double precision, and against closed forms.
#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>

#include <glm/geometric.hpp>
#include <gmock/gmock.h>
#include <hwy/highway.h>

#include "pipeline/volume/level_scale.h"
#include "pipeline/volume/volume_geometry.h"
#include "tests/support/allocation_counter.h"
#include "tests/support/fails_with.h"
#include "tests/ui/support/instruction_sets.h"
#include "tests/ui/support/reference_rays.h"
#include "tests/ui/support/synthetic_volume.h"
#include "tests/ui/support/view_places.h"
#include "ui/ray_caster/ray_caster.h"
#include "ui/view/plane_box.h"

namespace octascope::tests {
namespace {

constexpr int width = 97; // multiples of no packet
constexpr int height = 63;
constexpr double aspect = static_cast<double>(width) / height;
constexpr pipeline::VolumeGeometry tissue{70, 45, 21, 25.6, 66.7, 142.9}; // of small bricks
constexpr pipeline::VolumeGeometry cube{32, 32, 32, 50, 50, 50};

ui::RayCaster make_caster(std::string_view isa = {}, std::size_t helpers = 1) {
  auto made =
      ui::RayCaster::create(std::make_shared<ui::WorkTeam>(helpers, pipeline::ThreadSetup{}), isa);
  EXPECT_TRUE(made) << made.error().message;
  return std::move(*made);
}

hal::Result<> show(ui::RayCaster& caster, const pipeline::Volume& volume) {
  pipeline::Occupancy occupancy{volume.geometry, pipeline::blank_depth_bins};
  if (volume.levels.size() == volume.geometry.voxels())
    occupancy.update(volume);
  return caster.show(volume, occupancy);
}

ui::RayImage cast(ui::RayCaster& caster, const ui::ViewState& state,
                  const ui::RaySettings& settings, int across = width, int down = height) {
  const auto table = std::make_unique<ui::TransferTable>();
  ui::make_window_table(state, *table);
  caster.set_transfer(*table);
  ui::RayImage image;
  image.resize(across, down);
  const ui::Camera camera = ui::make_camera(state, ui::box_extents_mm(caster.geometry()),
                                            static_cast<float>(across) / static_cast<float>(down));
  const auto drawn = caster.draw(camera, settings, image);
  EXPECT_TRUE(drawn) << drawn.error().message;
  return image;
}

int grey_of(std::uint32_t rgba) {
  EXPECT_EQ(rgba & 0xFFU, rgba >> 8U & 0xFFU);
  EXPECT_EQ(rgba & 0xFFU, rgba >> 16U & 0xFFU);
  return static_cast<int>(rgba & 0xFFU);
}
int opacity_of(std::uint32_t rgba) {
  return static_cast<int>(rgba >> 24U);
}

float step_for(const pipeline::VolumeGeometry& geometry, int steps) {
  return glm::length(ui::box_extents_mm(geometry)) / static_cast<float>(steps);
}

// Of each instruction set's many pictures.
#ifdef OCTASCOPE_SANITIZED
constexpr int columns = 49;
constexpr int rows = 31;
#else
constexpr int columns = width;
constexpr int rows = height;
#endif

class RayCasterIsa : public testing::TestWithParam<std::string> {};

INSTANTIATE_TEST_SUITE_P(Isas, RayCasterIsa, testing::ValuesIn(instruction_sets()),
                         [](const auto& each) { return each.param; });

// Rounding may move a sample across a face of the box, or the half of an opacity across a sample:
// single pixels may differ, the mean may not.
TEST_P(RayCasterIsa, agrees_with_double_precision_from_everywhere) {
  const pipeline::Volume volume = tissue_volume(tissue);
  ui::RayCaster caster = make_caster(GetParam());
  ASSERT_EQ(caster.isa(), GetParam());
  ASSERT_TRUE(show(caster, volume));
  ui::LightVolume light;
  light.show(volume);
  for (const ui::RayMode mode : {ui::RayMode::composite, ui::RayMode::shaded, ui::RayMode::maximum})
    for (const Place& place : places)
      for (const float opacity : {1.0F, 0.5F, 0.02F}) {
        const ui::ViewState state = view_from(place, opacity);
        light.prepare(ui::window_ramp(state));
        ui::RaySettings settings{mode, step_for(tissue, 300), true};
        settings.light = &light;
        const ui::RayImage image = cast(caster, state, settings, columns, rows);
        const ui::Camera camera =
            ui::make_camera(state, ui::box_extents_mm(tissue),
                            static_cast<float>(columns) / static_cast<float>(rows));
        const auto expected = reference_rays(volume, camera, state, settings, columns, rows);
        double grey = 0;
        double alpha = 0;
        double drawn = 0;
        int deep = 0;
        for (std::size_t i = 0; i < expected.size(); ++i) {
          grey += std::abs(grey_of(image.rgba[i]) - expected[i].grey);
          alpha += std::abs(opacity_of(image.rgba[i]) - expected[i].opacity);
          drawn += expected[i].opacity;
          const double depth = static_cast<double>(image.depth_mm[i]);
          const bool same = std::isinf(depth) ? std::isinf(expected[i].depth_mm)
                                              : std::abs(depth - expected[i].depth_mm) <
                                                    1.5 * static_cast<double>(settings.step_mm);
          deep += same ? 0 : 1;
        }
        const auto pixels = static_cast<double>(expected.size());
        const std::string where = std::string{place.name} + ", mode " +
                                  std::to_string(static_cast<int>(mode)) + ", opacity " +
                                  std::to_string(opacity);
        EXPECT_GT(drawn / pixels, 5) << where;
        EXPECT_LE(grey / pixels, 0.5) << where;
        EXPECT_LE(alpha / pixels, 0.5) << where;
        EXPECT_LE(deep / pixels, 0.02) << where;
      }
}

TEST_P(RayCasterIsa, leaping_over_empty_bricks_changes_not_one_bit) {
  // A few specks in much air: most bricks are empty, and some specks lie on the bricks' sides.
  pipeline::Volume volume = uniform_volume({150, 90, 60, 20, 33, 50}, 40);
  for (int i = 0; i < 60; ++i)
    volume.b_scan(i)[static_cast<std::size_t>((i * 37 % 90) * 150 + i * 53 % 150)] = 255;
  ui::RayCaster caster = make_caster(GetParam());
  ASSERT_TRUE(show(caster, volume));
  ui::LightVolume light;
  light.show(volume);
  for (const ui::RayMode mode : {ui::RayMode::composite, ui::RayMode::shaded, ui::RayMode::maximum})
    for (const Place& place : places) {
      const ui::ViewState state = view_from(place, 0.5F);
      ui::RaySettings settings{mode, step_for(volume.geometry, 700), true};
      settings.light = &light;
      light.prepare(ui::window_ramp(state));
      const ui::RayImage leapt = cast(caster, state, settings, columns, rows);
      EXPECT_LT(caster.occupied_share(), 0.1);
      settings.leap_empty = false;
      const ui::RayImage full = cast(caster, state, settings, columns, rows);
      EXPECT_EQ(caster.occupied_share(), 1);
      EXPECT_EQ(leapt.rgba, full.rgba) << place.name;
      EXPECT_EQ(leapt.depth_mm, full.depth_mm) << place.name;
      EXPECT_TRUE(std::ranges::any_of(leapt.rgba, [](auto rgba) { return rgba != 0; }))
          << place.name;
    }
}

// Two channels that do not follow the grey: the same light in other colours.
TEST(RayCaster, colours_weigh_as_grey_does) {
  ui::RayCaster caster = make_caster();
  ASSERT_TRUE(show(caster, tissue_volume(small_geometry)));
  const ui::ViewState state = view_from(places[0], 0.5F);
  for (const ui::RayMode mode :
       {ui::RayMode::composite, ui::RayMode::shaded, ui::RayMode::maximum}) {
    const ui::RaySettings settings{mode, step_for(small_geometry, 400), true};
    const ui::RayImage grey = cast(caster, state, settings);
    const auto table = std::make_unique<ui::TransferTable>();
    ui::make_window_table(state, *table);
    for (ui::TransferTable::Colour& colour : table->colour)
      colour = {colour.red, colour.red / 2, 0};
    table->window.reset();
    caster.set_transfer(*table);
    ui::RayImage coloured;
    coloured.resize(width, height);
    ASSERT_TRUE(caster.draw(
        ui::make_camera(state, ui::box_extents_mm(small_geometry), static_cast<float>(aspect)),
        settings, coloured));
    for (std::size_t i = 0; i < grey.rgba.size(); ++i) {
      const auto shade = static_cast<double>(grey.rgba[i] & 0xFFU);
      ASSERT_NEAR(static_cast<double>(coloured.rgba[i] & 0xFFU), shade, 2); // table and ramp
      ASSERT_NEAR(static_cast<double>(coloured.rgba[i] >> 8U & 0xFFU), shade / 2, 1.5);
      ASSERT_EQ(coloured.rgba[i] >> 16U & 0xFFU, 0U);
      ASSERT_NEAR(opacity_of(coloured.rgba[i]), opacity_of(grey.rgba[i]), 2);
    }
  }
}

TEST(RayCaster, draws_the_same_with_any_number_of_threads_and_allocates_nothing) {
  const pipeline::Volume volume = tissue_volume(small_geometry);
  ui::ViewState state = view_from(places[0], 0.5F);
  const auto table = std::make_unique<ui::TransferTable>();
  ui::make_window_table(state, *table);
  const ui::RaySettings settings{ui::RayMode::composite, step_for(small_geometry, 400), true};
  std::vector<std::uint32_t> first;
  for (const std::size_t helpers : {0U, 1U, 3U}) {
    ui::RayCaster caster = make_caster({}, helpers);
    ASSERT_TRUE(show(caster, volume));
    ui::RayImage image = cast(caster, state, settings);
    if (first.empty())
      first = image.rgba;
    pipeline::Occupancy occupancy{volume.geometry, pipeline::blank_depth_bins};
    const std::uint64_t before = allocations_of_this_thread();
    for (int i = 0; i < 20; ++i) {
      occupancy.update(volume);
      ASSERT_TRUE(caster.show(volume, occupancy));
      table->opacity[100] = 0.001F * static_cast<float>(i); // a window that is being turned
      table->window->opacity = 0.5F + table->opacity[100];
      caster.set_transfer(*table);
      static_cast<void>(caster.draw(
          ui::make_camera(state, ui::box_extents_mm(small_geometry), static_cast<float>(aspect)),
          settings, image));
    }
    EXPECT_EQ(allocations_of_this_thread(), before);
    image = cast(caster, state, settings);
    EXPECT_EQ(image.rgba, first) << helpers;
  }
}

// 1 − (1 − a)^(L / reference step), at any step. The dither adds or takes a part of one sample at
// either end, so neighbouring pixels are averaged.
TEST(RayCaster, uniform_slab_has_the_closed_form_opacity_at_any_step) {
  const pipeline::VolumeGeometry slab{64, 64, 16, 40, 40, 10};
  ui::RayCaster caster = make_caster();
  for (const int count : {90, 110, 150}) {
    ASSERT_TRUE(show(caster, uniform_volume(slab, static_cast<std::uint8_t>(count))));
    ui::ViewState state;
    state.yaw_deg = 0;
    state.tilt_deg = 0;
    state.distance = 8;
    state.window_offset_db = 0;
    state.window_size_db = 40;
    state.opacity = 1;
    const double grey = static_cast<double>(pipeline::level_db(static_cast<float>(count))) / 40;
    const double steps =
        0.16 / static_cast<double>(ui::reference_step_mm(ui::box_extents_mm(slab) / 2.0F));
    const double expected = 255 * (1 - std::pow(1 - grey, steps));
    for (const float step_mm : {0.016F, 0.004F, 0.001F}) {
      const ui::RayImage image = cast(caster, state, {ui::RayMode::composite, step_mm, true});
      double opacity = 0;
      double shade = 0;
      int pixels = 0;
      for (int y = 24; y < 40; ++y)
        for (int x = 40; x < 56; ++x, ++pixels) {
          const std::uint32_t rgba = image.rgba[static_cast<std::size_t>(y * width + x)];
          opacity += opacity_of(rgba);
          shade += grey_of(rgba);
        }
      EXPECT_NEAR(opacity / pixels, expected, 1) << count << " at " << step_mm;
      EXPECT_NEAR(shade / pixels, grey * expected, 1) << count << " at " << step_mm;
    }
  }
}

TEST(RayCaster, sphere_has_the_silhouette_of_its_cone_of_tangents) {
  constexpr double radius_mm = 0.9;
  const pipeline::Volume volume = ball_volume(96, radius_mm);
  ui::RayCaster caster = make_caster();
  ASSERT_TRUE(show(caster, volume));
  ui::ViewState state = view_from({"", 25, 40, 2}, 1);
  state.window_offset_db = pipeline::level_db(100); // begins at the surface
  state.window_size_db = 1;
  const ui::RayImage image = cast(caster, state, {ui::RayMode::composite, 0.004F, true}, 200, 200);
  const ui::Camera camera = ui::make_camera(state, ui::box_extents_mm(volume.geometry), 1);
  const double eye_mm = static_cast<double>(glm::length(camera.eye));
  const double tangent = radius_mm / std::sqrt(eye_mm * eye_mm - radius_mm * radius_mm);
  const double radius_pixels = tangent / static_cast<double>(camera.tan_half_height) * 100;
  double area = 0;
  for (const std::uint32_t rgba : image.rgba)
    area += opacity_of(rgba) / 255.0;
  EXPECT_NEAR(std::sqrt(area / std::numbers::pi), radius_pixels, 0.5);
  // The nearest point is one radius before the centre.
  const auto centre = static_cast<std::size_t>(100 * 200 + 100);
  EXPECT_NEAR(static_cast<double>(image.depth_mm[centre]), eye_mm - radius_mm, 0.02);
  EXPECT_TRUE(std::isinf(image.depth_mm[0]));
}

TEST(RayCaster, maximum_of_a_ramp_is_its_upper_end) {
  pipeline::Volume volume = uniform_volume(cube, 0);
  for (int b = 0; b < 32; ++b)
    for (int a = 0; a < 32; ++a)
      for (int z = 0; z < 32; ++z)
        volume.b_scan(b)[static_cast<std::size_t>(a * 32 + z)] =
            static_cast<std::uint8_t>(4 * b + a);
  ui::RayCaster caster = make_caster();
  ASSERT_TRUE(show(caster, volume));
  ui::ViewState state = view_from({"", 0, 0, 8}, 0.5F);
  state.window_offset_db = pipeline::lowest_level_db;
  state.window_size_db = 100;
  const ui::RayImage image = cast(caster, state, {ui::RayMode::maximum, 0.005F, true}, 64, 64);
  // Straight through the middle: the nearest B-scan, between A-scans 15 and 16.
  const double expected = 255 * (124 + 15.5) * 0.5 / 100;
  for (const std::size_t row : {31U, 32U}) {
    const std::uint32_t left = image.rgba[row * 64 + 31];
    const std::uint32_t right = image.rgba[row * 64 + 32];
    EXPECT_NEAR((grey_of(left) + grey_of(right)) / 2.0, expected, 0.6);
    EXPECT_NEAR((opacity_of(left) + opacity_of(right)) / 2.0, expected, 0.6);
  }
}

TEST(RayCaster, a_changed_window_or_volume_shows_in_the_next_picture) {
  ui::RayCaster caster = make_caster();
  ASSERT_TRUE(show(caster, uniform_volume(cube, 100)));
  ui::ViewState state = view_from({"", 0, 0, 3}, 1);
  state.window_offset_db = 0;
  state.window_size_db = 40;
  const ui::RaySettings settings{ui::RayMode::composite, 0.01F, true};
  const auto middle = [&] {
    return grey_of(cast(caster, state, settings, 64, 64).rgba[32 * 64 + 32]);
  };
  EXPECT_NEAR(middle(), 255 * 10.0 / 40, 1);
  state.window_offset_db = 20;
  EXPECT_EQ(middle(), 0) << "below the window all is clear";
  ASSERT_TRUE(show(caster, uniform_volume(cube, 140)));
  EXPECT_NEAR(middle(), 255 * 10.0 / 40, 1) << "bricks that were empty are not any more";
}

TEST(RayCaster, half_the_step_is_the_same_picture) {
  ui::RayCaster caster = make_caster();
  ASSERT_TRUE(show(caster, tissue_volume(small_geometry)));
  for (const Place& view : places) {
    const ui::ViewState state = view_from(view, 0.5F);
    const auto at = [&](int steps) {
      return cast(caster, state, {ui::RayMode::composite, step_for(small_geometry, steps), true});
    };
    const ui::RayImage coarse = at(512);
    const ui::RayImage fine = at(1024);
    double difference = 0;
    for (std::size_t i = 0; i < fine.rgba.size(); ++i)
      difference += std::abs(grey_of(fine.rgba[i]) - grey_of(coarse.rgba[i]));
    EXPECT_LE(difference / static_cast<double>(fine.rgba.size()), 0.01 * 255) << view.name;
  }
}

TEST(RayCaster, says_what_it_cannot_draw) {
  ui::RayCaster caster = make_caster();
  ui::RayImage image;
  image.resize(8, 8);
  EXPECT_THAT(caster.draw({}, {ui::RayMode::composite, 0.01F, true}, image),
              FailsWith(hal::ErrorCode::invalid_argument));
  pipeline::Volume torn = uniform_volume(cube, 0);
  torn.levels.pop_back();
  EXPECT_THAT(show(caster, torn), FailsSaying("32767"));
  EXPECT_THAT(
      ui::RayCaster::create(std::make_shared<ui::WorkTeam>(0, pipeline::ThreadSetup{}), "abacus"),
      FailsSaying("abacus"));
}

} // namespace
} // namespace octascope::tests
