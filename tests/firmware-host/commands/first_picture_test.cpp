// What a surgeon looks for stands out from its surroundings in the first picture of an eye, with
// nothing touched.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "firmware-host/commands/volume/render.h"
#include "firmware-host/run/volume_source.h"
#include "sim/phantoms/phantom_anterior_eye.h"
#include "sim/phantoms/phantom_instrument.h"
#include "tests/support/must.h"
#include "ui/view/camera.h"

namespace octascope::tests {
namespace {

using sim::AnteriorEye;

constexpr int picture_width = 960;
constexpr int picture_height = 720;

double linear_light(std::uint8_t value) {
  const double v = value / 255.0;
  return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}

pipeline::Volume load_eye() {
  firmware_host::VolumeRequest request;
  request.phantom = "anterior_eye";
  return must(firmware_host::load_volume(request)).volume;
}

class FirstPicture : public testing::TestWithParam<ui::Technique> {
protected:
  void SetUp() override {
    volume_ = load_eye();
    firmware_host::RenderOptions options;
    options.view.technique = GetParam();
    options.view.box_visible = false;
    options.width = picture_width;
    options.height = picture_height;
    auto picture = firmware_host::render_volume(volume_, options);
    ASSERT_TRUE(picture) << picture.error().message;
    picture_ = std::move(*picture);
    extents_ = ui::box_extents_mm(volume_.geometry);
    camera_ =
        ui::make_camera(options.view, extents_, static_cast<float>(picture_width) / picture_height);
  }

  // Relative luminance around a place of the phantom, the mean of 3 × 3 pixels.
  double luminance(float x_mm, float y_mm, float depth_mm) const {
    const glm::vec2 at = camera_.project({x_mm, extents_.y / 2 - depth_mm, y_mm});
    const int column = static_cast<int>(picture_width / 2.0F + at.x * picture_height);
    const int row = static_cast<int>(picture_height / 2.0F + at.y * picture_height);
    double sum = 0;
    for (int y = row - 1; y <= row + 1; ++y)
      for (int x = column - 1; x <= column + 1; ++x) {
        const auto pixel = picture_.pixel(std::clamp(x, 0, picture_width - 1),
                                          std::clamp(y, 0, picture_height - 1));
        sum += 0.2126 * linear_light(pixel[0]) + 0.7152 * linear_light(pixel[1]) +
               0.0722 * linear_light(pixel[2]);
      }
    return sum / 9;
  }

  pipeline::Volume volume_;
  pipeline::Image picture_;
  glm::vec3 extents_{};
  ui::Camera camera_{};
};

INSTANTIATE_TEST_SUITE_P(Techniques, FirstPicture, testing::ValuesIn(ui::all_techniques),
                         [](const auto& test) { return std::string{to_string(test.param)}; });

// Beside the pupil's edge, on the side that the forceps' shadow does not reach.
TEST_P(FirstPicture, shows_the_edge_of_the_iris) {
  double iris = 0;
  double pupil = 0;
  for (int degrees = 100; degrees <= 260; degrees += 5) {
    const float angle = static_cast<float>(degrees) * std::numbers::pi_v<float> / 180;
    const auto at = [&](float r_mm, float depth_mm) {
      return luminance(AnteriorEye::axis_x_mm + r_mm * std::cos(angle), r_mm * std::sin(angle),
                       depth_mm);
    };
    for (const float off_mm : {0.3F, 0.45F, 0.6F}) {
      iris += at(AnteriorEye::pupil_mm + off_mm,
                 AnteriorEye::iris_front_mm(AnteriorEye::pupil_mm + off_mm));
      pupil +=
          at(AnteriorEye::pupil_mm - off_mm, AnteriorEye::iris_front_mm(AnteriorEye::pupil_mm));
    }
  }
  EXPECT_GE(iris / pupil, 3);
}

// In the chamber, where the metal faces the beam, against the tissue beside it.
TEST_P(FirstPicture, shows_the_forceps) {
  const AnteriorEye eye{1};
  const pipeline::VolumeGeometry& g = volume_.geometry;
  double metal = 0;
  double beside = 0;
  int places = 0;
  for (int b = 0; b < g.b_scans; ++b) {
    const auto pose = eye.instrument()->pose((b + 0.5) / g.b_scans); // a loop of one volume
    const float y_mm = static_cast<float>((b + 0.5 - g.b_scans / 2.0) * g.b_spacing_um * 1e-3);
    for (float x_mm = -1; x_mm < 3.2F; x_mm += 0.1F) {
      const auto top = pose.top_at(x_mm, y_mm);
      if (!top || top->facing < 0.95F)
        continue;
      ++places;
      metal += luminance(x_mm, y_mm, top->depth_mm);
      for (const float side_mm : {-0.9F, 0.9F})
        beside += luminance(x_mm, y_mm + side_mm, top->depth_mm) / 2;
    }
  }
  EXPECT_GE(places, 30);
  EXPECT_GE(metal / beside, 3);
}

// The cornea is drawn weaker, but it is there: its dome against what is behind the volume.
TEST_P(FirstPicture, shows_the_cornea) {
  double cornea = 0;
  double outside = 0;
  for (float y_mm = -4; y_mm < -2; y_mm += 0.1F) {
    const float r_mm = std::abs(y_mm);
    cornea += luminance(AnteriorEye::axis_x_mm, y_mm, AnteriorEye::cornea_front_mm(r_mm) + 0.25F);
    outside += luminance(AnteriorEye::axis_x_mm, y_mm, AnteriorEye::cornea_front_mm(r_mm) - 1.5F);
  }
  EXPECT_GE(cornea / outside, 3);
}

// One picture of the eye for each way of looking at it.
class LooksOfAnEye : public testing::Test {
protected:
  static constexpr int width = 320;
  static constexpr int height = 240;

  void SetUp() override { volume_ = load_eye(); }

  void draw(const ui::ViewState& view) {
    firmware_host::RenderOptions options;
    options.view = view;
    options.view.box_visible = false;
    options.width = width;
    options.height = height;
    auto picture = firmware_host::render_volume(volume_, options);
    ASSERT_TRUE(picture) << picture.error().message;
    pictures_.push_back(std::move(*picture));
  }

  // Of any two, the mean over the channels of all pixels where there is tissue.
  void expect_different(double least) const {
    for (std::size_t i = 0; i < pictures_.size(); ++i)
      for (std::size_t k = 0; k < i; ++k) {
        double difference = 0;
        int tissue = 0;
        for (int y = 0; y < height; ++y)
          for (int x = 0; x < width; ++x) {
            const auto a = pictures_[i].pixel(x, y);
            const auto b = pictures_[k].pixel(x, y);
            constexpr int background = 24;
            if (std::max(std::ranges::max(a), std::ranges::max(b)) <= background)
              continue;
            for (std::size_t channel = 0; channel < 3; ++channel)
              difference += std::abs(a[channel] - b[channel]) / 3.0;
            ++tissue;
          }
        EXPECT_GE(difference / tissue, least) << i << " and " << k;
      }
  }

  ui::TransferSet transfers_;
  pipeline::Volume volume_;
  std::vector<pipeline::Image> pictures_;
};

// Each has a use of its own only if it looks different.
TEST_F(LooksOfAnEye, transfer_functions_differ) {
  for (const char* name : {"window", "smooth", "surface"}) {
    ui::ViewState view;
    view.transfer = *transfers_.function_named(name);
    draw(view);
  }
  expect_different(15);
}

TEST_F(LooksOfAnEye, colour_maps_differ) {
  for (std::size_t map = 0; map < transfers_.colour_maps().size(); ++map) {
    ui::ViewState view;
    view.colour_map = static_cast<int>(map);
    draw(view);
  }
  expect_different(12);
}

} // namespace
} // namespace octascope::tests
