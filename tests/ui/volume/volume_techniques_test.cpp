// Every way of drawing the volume against the others and against closed forms.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "pipeline/volume/level_scale.h"
#include "tests/ui/support/gl_test.h"
#include "tests/ui/support/synthetic_volume.h"
#include "tests/ui/support/view_places.h"
#include "tests/ui/support/volume_stage.h"
#include "ui/view/plane_box.h"

namespace octascope::tests {
namespace {

using ui::Technique;

constexpr Technique all[] = {Technique::slices, Technique::planes, Technique::rays,
                             Technique::shaded, Technique::maximum};
constexpr Technique ray_techniques[] = {Technique::rays, Technique::shaded, Technique::maximum};
// Those that draw grey and opacity by the same formula.
constexpr Technique composites[] = {Technique::slices, Technique::planes, Technique::rays};

ui::RayMode mode_of(Technique technique) {
  return technique == Technique::shaded    ? ui::RayMode::shaded
         : technique == Technique::maximum ? ui::RayMode::maximum
                                           : ui::RayMode::composite;
}

ui::ViewState view_from(const Place& place, Technique technique, float opacity = 0.5F) {
  ui::ViewState view = tests::view_from(place, opacity);
  view.technique = technique;
  return view;
}

float longest_edge_mm(const pipeline::VolumeGeometry& geometry) {
  const glm::vec3 extents = ui::box_extents_mm(geometry);
  return std::max({extents.x, extents.y, extents.z});
}

StageSettings steps(const pipeline::VolumeGeometry& geometry, float count) {
  StageSettings settings;
  settings.step_mm = longest_edge_mm(geometry) / count;
  return settings;
}

class VolumeTechniquesTest : public GlTest {
protected:
  void SetUp() override {
    GlTest::SetUp();
    if (!IsSkipped())
      stage_.emplace();
  }
  void TearDown() override { stage_.reset(); }

  void expect_as_rays(Technique technique, const pipeline::VolumeGeometry& geometry,
                      const StageSettings& settings, double most) {
    stage_->show(tissue_volume(geometry));
    for (const Place& place : places)
      for (const float opacity : {0.5F, 0.03F}) {
        const auto rays = stage_->draw(view_from(place, Technique::rays, opacity), settings);
        const auto others = stage_->draw(view_from(place, technique, opacity), settings);
        EXPECT_LE(mean_difference(rays, others), most) << place.name << ' ' << opacity;
      }
  }

  std::optional<VolumeStage> stage_;
};

TEST_F(VolumeTechniquesTest, processor_and_shader_cast_the_same_rays) {
  const pipeline::Volume volume = tissue_volume(small_geometry);
  stage_->show(volume);
  const StageSettings settings = steps(small_geometry, 400);
  for (const Technique technique : ray_techniques)
    for (const Place& place : places)
      for (const float opacity : {1.0F, 0.5F, 0.02F}) {
        const ui::ViewState view = view_from(place, technique, opacity);
        const StagePicture shader = stage_->draw(view, settings);
        const StagePicture processor = stage_->cast(view, mode_of(technique), settings);
        const std::string what = std::string{ui::to_string(technique)} + ", " + place.name + ", " +
                                 std::to_string(opacity);
        EXPECT_GT(mean_opacity(processor), 5) << what;
        EXPECT_LE(mean_difference(shader, processor), 1) << what;
        if (shader.depth_mm.empty())
          continue;
        std::size_t other = 0;
        for (std::size_t i = 0; i < shader.depth_mm.size(); ++i) {
          const float a = shader.depth_mm[i];
          const float b = processor.depth_mm[i];
          const bool same =
              std::isinf(b) ? std::isinf(a) : std::abs(a - b) < 1.5F * settings.step_mm;
          other += same ? 0 : 1;
        }
        // Half of an opacity may fall one sample on; of equal maxima, rounding chooses.
        EXPECT_LE(static_cast<double>(other) / static_cast<double>(shader.depth_mm.size()),
                  technique == Technique::maximum ? 0.1 : 0.02)
            << what;
      }
}

// Two levels from nothing to white, between B-scans far apart: filtering has to be finer than them.
TEST_F(VolumeTechniquesTest, narrow_windows_keep_their_ramp) {
  const pipeline::VolumeGeometry geometry{40, 40, 3, 25, 25, 500};
  pipeline::Volume volume = uniform_volume(geometry, 100);
  std::ranges::fill(volume.b_scan(1), std::uint8_t{101});
  std::ranges::fill(volume.b_scan(2), std::uint8_t{102});
  stage_->show(volume);
  StageSettings settings;
  settings.width = 256;
  settings.height = 256;
  settings.step_mm = 0.002F;
  ui::ViewState view = view_from({"", 90, 0, 3}, Technique::rays, 1);
  view.window_offset_db = pipeline::level_db(100);
  view.window_size_db = 1;
  for (const bool as_table : {false, true}) {
    settings.as_table = as_table;
    const StagePicture picture = stage_->draw(view, settings);
    // From B-scan to B-scan grey rises evenly: more values than levels or quarters of them.
    std::vector<float> greys;
    for (int x = 0; x < settings.width; ++x)
      if (picture.at(x, 128).opacity > 0.05F)
        greys.push_back(picture.at(x, 128).red);
    std::ranges::sort(greys);
    float widest = 0;
    for (std::size_t i = 1; i < greys.size(); ++i)
      widest = std::max(widest, greys[i] - greys[i - 1]);
    ASSERT_GT(greys.size(), 80U);
    EXPECT_LE(widest, 0.05F) << as_table;
  }
  for (const Technique technique : ray_techniques)
    EXPECT_LE(mean_difference(
                  stage_->draw(view_from(places[0], technique), settings),
                  stage_->cast(view_from(places[0], technique), mode_of(technique), settings)),
              1);
}

TEST_F(VolumeTechniquesTest, rays_are_the_plane_stacks_at_fine_spacing) {
  expect_as_rays(Technique::planes, small_geometry, steps(small_geometry, 1000), 2);
}

// As fine along every axis as along depth, so that nothing is lost between slices.
TEST_F(VolumeTechniquesTest, slices_are_the_rays_of_a_smooth_volume) {
  const pipeline::VolumeGeometry fine{180, 300, 300, 10, 10, 10};
  expect_as_rays(Technique::slices, fine, steps(fine, 600), 4);
}

TEST_F(VolumeTechniquesTest, half_the_step_is_the_same_picture) {
  stage_->show(tissue_volume(small_geometry));
  for (const Technique technique :
       {Technique::planes, Technique::rays, Technique::shaded, Technique::maximum})
    for (const Place& place : places) {
      const ui::ViewState view = view_from(place, technique);
      const StagePicture coarse = stage_->draw(view, steps(small_geometry, 512));
      const StagePicture fine = stage_->draw(view, steps(small_geometry, 1024));
      EXPECT_LE(mean_difference(coarse, fine), 0.01 * 255)
          << ui::to_string(technique) << ' ' << place.name;
    }
}

TEST_F(VolumeTechniquesTest, a_window_looks_the_same_computed_and_looked_up) {
  stage_->show(tissue_volume(small_geometry));
  StageSettings computed = steps(small_geometry, 256);
  StageSettings looked_up = computed;
  looked_up.as_table = true;
  for (const Technique technique : all)
    for (const float window_size_db : {1.0F, 36.0F})
      for (const float opacity : {1.0F, 0.1F}) {
        ui::ViewState view = view_from(places[0], technique, opacity);
        view.window_offset_db = 20;
        view.window_size_db = window_size_db;
        const StagePicture a = stage_->draw(view, computed);
        const StagePicture b = stage_->draw(view, looked_up);
        float largest = 0;
        for (std::size_t i = 0; i < a.pixels.size(); ++i)
          largest = std::max({largest, std::abs(a.pixels[i].red - b.pixels[i].red),
                              std::abs(a.pixels[i].opacity - b.pixels[i].opacity)});
        EXPECT_GT(mean_opacity(a), 5);
        EXPECT_LE(largest, 1.0F / 255)
            << ui::to_string(technique) << ' ' << window_size_db << ' ' << opacity;
      }
}

// Two channels that do not follow the grey: the same light in other colours.
TEST_F(VolumeTechniquesTest, colours_weigh_as_grey_does) {
  stage_->show(tissue_volume(small_geometry));
  const StageSettings settings = steps(small_geometry, 256);
  for (const Technique technique : all) {
    const ui::ViewState view = view_from(places[0], technique);
    const auto table = std::make_unique<ui::TransferTable>();
    ui::make_window_table(view, *table);
    for (ui::TransferTable::Colour& colour : table->colour)
      colour = {colour.red, colour.red / 2, 0};
    table->window.reset();
    const StagePicture grey = stage_->draw(view, settings);
    const StagePicture coloured = stage_->draw(view, *table, settings);
    for (std::size_t i = 0; i < grey.pixels.size(); ++i) {
      ASSERT_NEAR(coloured.pixels[i].red, grey.pixels[i].red, 1.0F / 255);
      ASSERT_NEAR(coloured.pixels[i].green, grey.pixels[i].red / 2, 0.5F / 255);
      ASSERT_EQ(coloured.pixels[i].blue, 0);
      ASSERT_NEAR(coloured.pixels[i].opacity, grey.pixels[i].opacity, 1.0F / 255);
    }
  }
}

std::unique_ptr<ui::TransferTable> depth_table(const ui::ViewState& view) {
  auto table = std::make_unique<ui::TransferTable>();
  ui::make_window_table(view, *table);
  table->window.reset();
  table->depths = ui::DepthColours{0.2F, 0.7F};
  return table;
}

TEST_F(VolumeTechniquesTest, processor_and_shader_colour_depths_alike) {
  stage_->show(tissue_volume(small_geometry));
  const StageSettings settings = steps(small_geometry, 400);
  for (const Technique technique : ray_techniques)
    for (const Place& place : places)
      for (const float opacity : {1.0F, 0.5F, 0.02F}) {
        const ui::ViewState view = view_from(place, technique, opacity);
        const auto table = depth_table(view);
        const StagePicture shader = stage_->draw(view, *table, settings);
        const StagePicture processor = stage_->cast(view, *table, mode_of(technique), settings);
        EXPECT_GT(mean_opacity(processor), 5);
        EXPECT_LE(mean_difference(shader, processor), 1)
            << ui::to_string(technique) << ", " << place.name << ", " << opacity;
      }
}

// Seen from the side, a row of the picture is a depth.
TEST_F(VolumeTechniquesTest, the_hue_is_that_of_the_depth) {
  const pipeline::VolumeGeometry block{200, 60, 30, 10, 33, 10}; // 2 mm deep, 0.3 mm thick
  stage_->show(uniform_volume(block, 140));
  StageSettings settings;
  settings.width = 60;
  settings.height = 200;
  const auto expect_hues = [&](const StagePicture& picture, const ui::ViewState& view,
                               const std::string& what) {
    const ui::Camera camera = ui::make_camera(view, ui::box_extents_mm(block), 0.3F);
    const float mm_a_pixel = 2 * camera.tan_half_height * glm::length(camera.eye) / 200;
    for (int y = 0; y < settings.height; ++y) {
      // In the middle of its thickness; all of it is within a pixel there. A pixel is 4 % of the hues.
      const float depth_mm = 1 + (static_cast<float>(y) + 0.5F - 100) * mm_a_pixel;
      if (depth_mm < 0.2F || depth_mm > 1.8F)
        continue;
      const auto& pixel = picture.at(30, y);
      ASSERT_GT(pixel.opacity, 0.05F) << what;
      const auto tint = ui::depth_tint(ui::DepthColours{0.2F, 0.7F}.place_of(depth_mm / 2));
      const float grey = pixel.green / tint[1];
      EXPECT_NEAR(pixel.red, grey * tint[0], 0.06F * grey + 0.004F) << what << ' ' << depth_mm;
      EXPECT_NEAR(pixel.blue, grey * tint[2], 0.06F * grey + 0.004F) << what << ' ' << depth_mm;
    }
  };
  for (const Technique technique : all) {
    const ui::ViewState view = view_from({"", 0, 0, 8}, technique, 0.1F);
    const auto table = depth_table(view);
    const std::string name{ui::to_string(technique)};
    expect_hues(stage_->draw(view, *table, settings), view, name);
    if (ui::casts_rays(technique))
      expect_hues(stage_->cast(view, *table, mode_of(technique), settings), view,
                  name + " by the processor");
  }
}

TEST_F(VolumeTechniquesTest, leaping_over_empty_bricks_changes_not_one_bit) {
  // A few specks in much air, just below the window (level 120), so that all of a speck's cells
  // show up to their sides: most bricks are empty, and some specks lie on the bricks' sides.
  pipeline::Volume specks = uniform_volume({150, 90, 60, 20, 33, 50}, 119);
  for (int i = 0; i < 60; ++i)
    specks.b_scan(i)[static_cast<std::size_t>((i * 37 % 90) * 150 + i * 53 % 150)] = 255;
  for (const pipeline::Volume& volume : {specks, tissue_volume(small_geometry)}) {
    stage_->show(volume);
    for (const Technique technique : ray_techniques)
      for (const Place& place : places)
        for (const bool as_table : {false, true}) {
          StageSettings settings = steps(volume.geometry, 700);
          settings.width = 96;
          settings.height = 64;
          settings.as_table = as_table;
          ui::ViewState view = view_from(place, technique);
          view.window_offset_db = 20; // exactly a level: where a brick may just begin to show
          const StagePicture leapt = stage_->draw(view, settings);
          settings.leap_empty = false;
          const StagePicture full = stage_->draw(view, settings);
          EXPECT_GT(mean_opacity(full), 0) << place.name;
          EXPECT_EQ(leapt.pixels, full.pixels) << ui::to_string(technique) << ' ' << place.name;
          EXPECT_EQ(leapt.depth_mm, full.depth_mm) << ui::to_string(technique) << ' ' << place.name;
        }
  }
}

// 1 − (1 − a)^(L / reference step), for every technique that composites, at any step.
TEST_F(VolumeTechniquesTest, uniform_slab_has_the_closed_form_opacity) {
  const pipeline::VolumeGeometry slab{64, 64, 16, 40, 40, 10};
  const double reference =
      static_cast<double>(ui::reference_step_mm(ui::box_extents_mm(slab) / 2.0F));
  for (const int count : {90, 110, 150}) {
    stage_->show(uniform_volume(slab, static_cast<std::uint8_t>(count)));
    const double grey = static_cast<double>(pipeline::level_db(static_cast<float>(count))) / 40;
    const double expected = 255 * (1 - std::pow(1 - grey, 0.16 / reference));
    for (const Technique technique : composites)
      for (const float step_mm : {0.04F, 0.016F, 0.004F, 0.001F}) {
        ui::ViewState view = view_from({"", 0, 0, 8}, technique, 1);
        view.window_offset_db = 0;
        view.window_size_db = 40;
        StageSettings settings;
        settings.step_mm = step_mm;
        const StagePicture picture = stage_->draw(view, settings);
        double opacity = 0;
        double shade = 0;
        for (int y = 42; y < 58; ++y) // the dither's average
          for (int x = 72; x < 88; ++x) {
            opacity += 255 * static_cast<double>(picture.at(x, y).opacity) / 256;
            shade += 255 * static_cast<double>(picture.at(x, y).red) / 256;
          }
        const std::string what = std::string{ui::to_string(technique)} + ' ' +
                                 std::to_string(count) + " at " + std::to_string(step_mm);
        EXPECT_NEAR(opacity, expected, 1) << what;
        EXPECT_NEAR(shade, grey * expected, 1) << what;
      }
  }
}

TEST_F(VolumeTechniquesTest, oblique_rays_are_longer_and_so_more_opaque) {
  const pipeline::VolumeGeometry slab{64, 64, 16, 40, 40, 10};
  stage_->show(uniform_volume(slab, 90));
  const double reference =
      static_cast<double>(ui::reference_step_mm(ui::box_extents_mm(slab) / 2.0F));
  for (const Technique technique : composites)
    for (const float yaw_deg : {40.0F, 60.0F}) { // slices of the slow, then of the fast axis
      ui::ViewState view = view_from({"", yaw_deg, 0, 8}, technique, 1);
      view.window_offset_db = 0;
      view.window_size_db = 40;
      StageSettings settings;
      settings.step_mm = 0.004F;
      const StagePicture picture = stage_->draw(view, settings);
      const double length = 0.16 / std::cos(static_cast<double>(glm::radians(yaw_deg)));
      const double expected = 255 * (1 - std::pow(1 - 5.0 / 40, length / reference));
      double opacity = 0;
      for (int y = 46; y < 54; ++y)
        for (int x = 76; x < 84; ++x)
          opacity += 255 * static_cast<double>(picture.at(x, y).opacity) / 64;
      EXPECT_NEAR(opacity, expected, 2) << ui::to_string(technique) << ' ' << yaw_deg;
    }
}

TEST_F(VolumeTechniquesTest, sphere_has_the_silhouette_of_its_cone_of_tangents) {
  constexpr double radius_mm = 0.9;
  const pipeline::Volume volume = ball_volume(96, radius_mm);
  stage_->show(volume);
  StageSettings settings;
  settings.width = 200;
  settings.height = 200;
  settings.step_mm = 0.004F;
  for (const Technique technique : all) {
    ui::ViewState view = view_from({"", 25, 40, 2}, technique, 1);
    view.window_offset_db = pipeline::level_db(100); // begins at the surface
    view.window_size_db = 1;
    const StagePicture picture = stage_->draw(view, settings);
    const ui::Camera camera = ui::make_camera(view, ui::box_extents_mm(volume.geometry), 1);
    const double eye_mm = static_cast<double>(glm::length(camera.eye));
    const double tangent = radius_mm / std::sqrt(eye_mm * eye_mm - radius_mm * radius_mm);
    const double radius_pixels = tangent / static_cast<double>(camera.tan_half_height) * 100;
    const double area = mean_opacity(picture) / 255 * 200 * 200;
    EXPECT_NEAR(std::sqrt(area / std::numbers::pi), radius_pixels, 0.7) << ui::to_string(technique);
    if (picture.depth_mm.empty())
      continue;
    const auto centre = static_cast<double>(picture.depth_mm[100 * 200 + 100]);
    if (technique == Technique::rays || technique == Technique::shaded) {
      EXPECT_NEAR(centre, eye_mm - radius_mm, 0.02) << ui::to_string(technique);
    }
    if (technique == Technique::slices || technique == Technique::planes) {
      EXPECT_TRUE(std::isinf(centre)) << ui::to_string(technique);
    }
    EXPECT_TRUE(std::isinf(picture.depth_mm[0])) << ui::to_string(technique);
  }
}

TEST_F(VolumeTechniquesTest, maximum_of_a_ramp_is_its_upper_end) {
  pipeline::Volume volume = uniform_volume({32, 32, 32, 50, 50, 50}, 0);
  for (int b = 0; b < 32; ++b)
    for (int a = 0; a < 32; ++a)
      for (int z = 0; z < 32; ++z)
        volume.b_scan(b)[static_cast<std::size_t>(a * 32 + z)] =
            static_cast<std::uint8_t>(4 * b + a);
  stage_->show(volume);
  ui::ViewState view = view_from({"", 0, 0, 8}, Technique::maximum);
  view.window_offset_db = pipeline::lowest_level_db;
  view.window_size_db = 100;
  StageSettings settings;
  settings.width = 64;
  settings.height = 64;
  settings.step_mm = 0.005F;
  const StagePicture picture = stage_->draw(view, settings);
  // Straight through the middle: the nearest B-scan, between A-scans 15 and 16.
  const double expected = 255 * (124 + 15.5) * 0.5 / 100;
  const double found = 127.5 * static_cast<double>(picture.at(31, 31).red + picture.at(32, 31).red);
  EXPECT_NEAR(found, expected, 0.7);
  EXPECT_EQ(picture.at(31, 31).red, picture.at(31, 31).opacity);
}

// The box against the matrices, with every technique and shape of picture.
TEST_F(VolumeTechniquesTest, the_box_has_its_physical_aspect) {
  const pipeline::VolumeGeometry flat{512, 100, 50, 2, 30, 20}; // 1.024 × 3 × 1 mm
  stage_->show(uniform_volume(flat, 160));
  struct Size {
    int width, height;
  };
  for (const Technique technique : all)
    for (const Size size : {Size{200, 200}, Size{320, 180}, Size{90, 160}, Size{7, 5}}) {
      ui::ViewState view = view_from({"", 0, 0, 5}, technique, 1);
      StageSettings settings;
      settings.width = size.width;
      settings.height = size.height;
      settings.step_mm = 0.01F;
      const StagePicture picture = stage_->draw(view, settings);
      const ui::Camera camera =
          ui::make_camera(view, ui::box_extents_mm(flat),
                          static_cast<float>(size.width) / static_cast<float>(size.height));
      const glm::vec2 corner = camera.project({1.5F, 0.512F, 0.5F});
      const float right =
          static_cast<float>(size.width) / 2 + corner.x * static_cast<float>(size.height);
      const float top =
          static_cast<float>(size.height) / 2 + corner.y * static_cast<float>(size.height);
      const int middle = size.height / 2;
      for (int x = size.width / 2; x < size.width; ++x) {
        const float centre = static_cast<float>(x) + 0.5F;
        if (std::abs(centre - right) > 1.5F) {
          EXPECT_EQ(picture.at(x, middle).opacity > 0.1F, centre < right)
              << ui::to_string(technique) << ' ' << size.width << ' ' << x;
        }
      }
      for (int y = 0; y < middle; ++y) {
        const float centre = static_cast<float>(y) + 0.5F;
        if (std::abs(centre - top) > 1.5F) {
          EXPECT_EQ(picture.at(size.width / 2, y).opacity > 0.1F, centre > top)
              << ui::to_string(technique) << ' ' << size.height << ' ' << y;
        }
      }
    }
}

TEST_F(VolumeTechniquesTest, blank_depths_are_left_out) {
  pipeline::Volume volume = uniform_volume({32, 32, 32, 50, 50, 50}, 0);
  for (int b = 0; b < 32; ++b)
    for (int a = 0; a < 32; ++a)
      std::fill_n(volume.b_scan(b).begin() + a * 32, 2, std::uint8_t{255});
  stage_->show(volume);
  StageSettings settings;
  for (const Technique technique : all)
    for (const Place& place : places) {
      ui::ViewState view = view_from(place, technique, 1);
      view.window_offset_db = 0;
      const StagePicture picture = stage_->draw(view, settings);
      EXPECT_EQ(mean_opacity(picture), 0) << ui::to_string(technique) << ' ' << place.name;
    }
}

TEST_F(VolumeTechniquesTest, a_changed_window_shows_where_bricks_were_empty) {
  stage_->show(uniform_volume({64, 64, 64, 25, 25, 25}, 100)); // 10 dB
  StageSettings settings;
  for (const Technique technique : all) {
    ui::ViewState view = view_from({"", 0, 0, 3}, technique, 1);
    view.window_offset_db = 20;
    view.window_size_db = 20;
    EXPECT_EQ(mean_opacity(stage_->draw(view, settings)), 0) << ui::to_string(technique);
    view.window_offset_db = 0;
    const StagePicture picture = stage_->draw(view, settings);
    EXPECT_NEAR(picture.at(80, 50).red, technique == Technique::shaded ? 0.3F : 0.5F,
                technique == Technique::shaded ? 0.1F : 0.01F)
        << ui::to_string(technique);
  }
}

} // namespace
} // namespace octascope::tests
