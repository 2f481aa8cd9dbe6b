// Rings and grain: what a picture of few samples a ray adds to a smooth surface.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "pipeline/volume/level_scale.h"
#include "pipeline/volume/volume_geometry.h"
#include "tests/ui/support/view_places.h"
#include "ui/dither/dither_mask.h"
#include "ui/ray_caster/ray_caster.h"

namespace octascope::tests {
namespace {

constexpr pipeline::VolumeGeometry geometry{300, 200, 60, 5, 15, 50};
constexpr float longest_mm = 3;
constexpr int width = 640;
constexpr int height = 400;

// A bright skin of three voxels on darker tissue, domed and slanted, without speckle: every
// structure in its pictures but the dome's own is the sampling's.
pipeline::Volume dome() {
  pipeline::Volume volume{geometry};
  std::ranges::fill(volume.b_scan_states, pipeline::BScanState::good);
  for (int b = 0; b < geometry.b_scans; ++b)
    for (int a = 0; a < geometry.a_scans; ++a) {
      const double x = (a - 90) * 0.015;
      const double y = (b - 25) * 0.05;
      const double surface = 60 + 60 * (x * x + y * y) / 2 + 20 * x;
      for (int z = 0; z < geometry.depths; ++z) {
        const double below = z - surface;
        const double tissue = below > 0 ? 120 - 0.2 * below : 40;
        const double skin = 160 * std::exp(-below * below / 4.5);
        volume.b_scan(b)[static_cast<std::size_t>(a * geometry.depths + z)] =
            static_cast<std::uint8_t>(std::max(tissue, 40 + skin));
      }
    }
  return volume;
}

class GrainTest : public testing::TestWithParam<ui::RayMode> {
protected:
  void SetUp() override {
    auto made = ui::RayCaster::create(std::make_shared<ui::WorkTeam>(1, pipeline::ThreadSetup{}));
    ASSERT_TRUE(made) << made.error().message;
    caster_ = std::make_unique<ui::RayCaster>(std::move(*made));
    const pipeline::Volume volume = dome();
    pipeline::Occupancy occupancy{geometry, pipeline::blank_depth_bins};
    occupancy.update(volume);
    ASSERT_TRUE(caster_->show(volume, occupancy));
  }

  // Grey of each pixel.
  std::vector<double> draw(const Place& place, int steps) {
    ui::ViewState view = view_from(place, 0.5F);
    view.window_offset_db = pipeline::level_db(90);
    view.window_size_db = 40;
    const auto table = std::make_unique<ui::TransferTable>();
    ui::make_window_table(view, *table);
    caster_->set_transfer(*table);
    ui::RayImage image;
    image.resize(width, height);
    const ui::Camera camera =
        ui::make_camera(view, ui::box_extents_mm(geometry), static_cast<float>(width) / height);
    ui::RaySettings settings{GetParam(), longest_mm / static_cast<float>(steps), true};
    settings.soften = soften_;
    EXPECT_TRUE(caster_->draw(camera, settings, image));
    std::vector<double> grey;
    for (const std::uint32_t rgba : image.rgba)
      grey.push_back(rgba & 0xFFU);
    return grey;
  }

  bool soften_ = true;
  std::unique_ptr<ui::RayCaster> caster_;
};

std::vector<double> smoothed(const std::vector<double>& picture, int radius) {
  const auto along = [&](const std::vector<double>& from, int dx, int dy) {
    std::vector<double> to(from.size());
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        double sum = 0;
        for (int k = -radius; k <= radius; ++k)
          sum += from[static_cast<std::size_t>(std::clamp(y + k * dy, 0, height - 1) * width +
                                               std::clamp(x + k * dx, 0, width - 1))];
        to[static_cast<std::size_t>(y * width + x)] = sum / (2 * radius + 1);
      }
    return to;
  };
  return along(along(picture, 1, 0), 0, 1);
}

struct Excess {
  double grain; // of pixels against their neighbourhood, root mean square in counts of 255
  double rings; // of neighbourhoods against wider ones
};

// Of what the picture differs by from one of many samples, over all that is drawn.
Excess excess_of(const std::vector<double>& picture, const std::vector<double>& truth) {
  std::vector<double> difference(truth.size());
  for (std::size_t i = 0; i < truth.size(); ++i)
    difference[i] = picture[i] - truth[i];
  const std::vector<double> near = smoothed(difference, 3);
  const std::vector<double> wide = smoothed(near, 15);
  double grain = 0;
  double rings = 0;
  double count = 0;
  for (std::size_t i = 0; i < truth.size(); ++i)
    if (truth[i] > 0) {
      grain += std::pow(difference[i] - near[i], 2);
      rings += std::pow(near[i] - wide[i], 2);
      ++count;
    }
  return {std::sqrt(grain / count), std::sqrt(rings / count)};
}

INSTANTIATE_TEST_SUITE_P(Modes, GrainTest,
                         testing::Values(ui::RayMode::composite, ui::RayMode::maximum),
                         [](const auto& mode) {
                           return mode.param == ui::RayMode::maximum ? "maximum" : "composite";
                         });

// Without the average: 0.9 to 45 (composite), 3 to 65 (maximum).
TEST_P(GrainTest, few_samples_show_little_grain) {
  struct Bound {
    int steps;
    double composite, maximum;
  };
  for (const Place& place : {Place{"oblique", 35, 35, 3.1F}, Place{"from above", 0, 89, 2.5F},
                             Place{"grazing", 45, 10, 2}}) {
    soften_ = true;
    const std::vector<double> truth = draw(place, 4096);
    soften_ = false;
    const std::vector<double> sharp_truth = draw(place, 4096);
    for (const Bound& bound : {Bound{512, 0.8, 3.2}, {256, 1.8, 6.5}, {128, 8, 15}, {80, 11, 18}}) {
      soften_ = true;
      const Excess soft = excess_of(draw(place, bound.steps), truth);
      soften_ = false;
      const Excess hard = excess_of(draw(place, bound.steps), sharp_truth);
      const bool maximum = GetParam() == ui::RayMode::maximum;
      EXPECT_LE(soft.grain, maximum ? bound.maximum : bound.composite)
          << place.name << ' ' << bound.steps;
      EXPECT_LE(soft.grain, 0.6 * hard.grain) << place.name << ' ' << bound.steps;
      EXPECT_LE(soft.rings, hard.rings) << place.name << ' ' << bound.steps;
    }
  }
}

TEST(DitherMask, has_each_value_once_and_its_neighbours_average_alike) {
  const ui::DitherMask& mask = ui::dither_mask();
  std::vector<float> sorted(mask.begin(), mask.end());
  std::ranges::sort(sorted);
  for (std::size_t i = 0; i < sorted.size(); ++i)
    EXPECT_FLOAT_EQ(sorted[i], (static_cast<float>(i) + 0.5F) / static_cast<float>(sorted.size()));
  // Of numbers drawn by chance, means of nine would spread by 0.096.
  double squares = 0;
  for (int y = 0; y < ui::dither_size; ++y)
    for (int x = 0; x < ui::dither_size; ++x) {
      double sum = 0;
      for (int dy = 0; dy < 3; ++dy)
        for (int dx = 0; dx < 3; ++dx)
          sum += static_cast<double>(mask[static_cast<std::size_t>(
              (y + dy) % ui::dither_size * ui::dither_size + (x + dx) % ui::dither_size)]);
      squares += std::pow(sum / 9 - 0.5, 2);
    }
  EXPECT_LE(std::sqrt(squares / static_cast<double>(mask.size())), 0.05);
}

} // namespace
} // namespace octascope::tests
