// The calliper on a phantom whose sizes are known: the cornea at its apex, from the spectra on.
#include <cmath>

#include <gtest/gtest.h>

#include "firmware-host/run/volume_source.h"
#include "sim/phantoms/phantom_anterior_eye.h"
#include "ui/controls/view_actions.h"
#include "ui/hud/calliper.h"

namespace octascope::tests {
namespace {

using sim::AnteriorEye;

TEST(Calliper, measures_the_phantoms_cornea_within_a_voxel_in_tissue_and_in_air) {
  firmware_host::VolumeRequest request;
  request.phantom = "anterior_eye";
  const auto loaded = firmware_host::load_volume(request);
  ASSERT_TRUE(loaded) << loaded.error().message;
  const pipeline::Volume& volume = loaded->volume;
  const pipeline::VolumeGeometry& g = volume.geometry;

  // The A-scan at the eye's axis, and the brightest voxel near a depth of it.
  const int a =
      static_cast<int>((static_cast<double>(AnteriorEye::axis_x_mm) / g.a_mm() + 0.5) * g.a_scans);
  const int b = g.b_scans / 2;
  const auto brightest_near = [&](float depth_mm) {
    const int middle = static_cast<int>(static_cast<double>(depth_mm) * 1e3 / g.depth_spacing_um);
    const auto line = volume.b_scan(b).subspan(static_cast<std::size_t>(a * g.depths));
    int best = middle - 12;
    for (int z = best; z <= middle + 12; ++z)
      if (line[static_cast<std::size_t>(z)] > line[static_cast<std::size_t>(best)])
        best = z;
    return best;
  };
  const int front = brightest_near(AnteriorEye::cornea_front_mm(0));
  const int back = brightest_near(AnteriorEye::cornea_back_mm(0));

  // Put there as a knob does.
  ui::ViewActions actions{{}, g, {ui::Action::b_scan}};
  const auto turn_to = [&](ui::Action action, int wanted) {
    const float now = ui::number_of(action)->of(actions.state());
    actions.perform(action, static_cast<double>(wanted) - static_cast<double>(now),
                    ui::Done::turned, {});
  };
  turn_to(ui::Action::mark_1_across, a);
  turn_to(ui::Action::mark_2_across, a);
  turn_to(ui::Action::mark_1_depth, front);
  turn_to(ui::Action::mark_2_depth, back);
  EXPECT_TRUE(actions.state().calliper);

  const double known_mm =
      static_cast<double>(AnteriorEye::cornea_back_mm(0) - AnteriorEye::cornea_front_mm(0));
  const double voxel_mm = g.depth_spacing_um * 1e-3;
  const ui::CalliperDistance distance = ui::calliper_distance(actions.state(), g);
  ASSERT_TRUE(distance.tissue_mm && distance.air_mm && g.refractive_index);
  EXPECT_NEAR(*distance.tissue_mm, known_mm, voxel_mm);
  EXPECT_NEAR(*distance.air_mm, known_mm * *g.refractive_index, voxel_mm * *g.refractive_index);

  // Of the same marks two voxels apart across, too: the hypotenuse.
  turn_to(ui::Action::mark_2_across, a + 2);
  EXPECT_NEAR(*ui::calliper_distance(actions.state(), g).tissue_mm,
              std::hypot(*distance.tissue_mm, 2 * g.a_spacing_um * 1e-3), 1e-9);
}

TEST(Calliper, tells_tissue_from_air_and_admits_an_unknown_medium) {
  ui::ViewState view;
  view.mark_1_a = view.mark_2_a = 10;
  view.mark_1_depth = 100;
  view.mark_2_depth = 200;
  const auto words = [&](std::optional<double> index, double spacing_um) {
    const auto text = words_of(ui::calliper_distance(view, {.depths = 512,
                                                            .a_scans = 300,
                                                            .b_scans = 80,
                                                            .depth_spacing_um = spacing_um,
                                                            .refractive_index = index}));
    return std::string{text.view()};
  };
  EXPECT_EQ(words(1.38, 5), "500 µm in tissue, 690 µm in air");
  EXPECT_EQ(words(1.0, 6.9), "500 µm in tissue, 690 µm in air") << "depths stored in air";
  EXPECT_EQ(words(1.38, 12), "1.20 mm in tissue, 1.66 mm in air");
  EXPECT_EQ(words(std::nullopt, 5), "500 µm, refractive index unknown");
}

} // namespace
} // namespace octascope::tests
