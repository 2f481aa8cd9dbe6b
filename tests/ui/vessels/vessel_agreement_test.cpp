// The hybrid's picture against that of quads: one shape, whoever draws it.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "tests/support/vessels/random_tree.h"
#include "tests/ui/support/gl_test.h"
#include "tests/ui/support/vessels/reference_vessels.h"
#include "tests/ui/support/vessels/vessel_stage.h"
#include "ui/vessels/hybrid/hybrid_method.h"
#include "ui/vessels/hybrid/quads_share.h"

namespace octascope::tests {
namespace {

using ui::VesselMethodKind;

constexpr float processor_only = std::numeric_limits<float>::infinity();

// Segments of at least that radius go to GL.
ui::HybridMethod make_hybrid(float gl_radius_px) {
  auto quads = ui::QuadsShare::create(std::make_shared<ui::NodeTexture>());
  EXPECT_TRUE(quads) << quads.error().message;
  auto hybrid = ui::HybridMethod::create(1, {}, {std::move(*quads), gl_radius_px});
  EXPECT_TRUE(hybrid) << hybrid.error().message;
  return std::move(*hybrid);
}

// Nearer to an outline the hybrid's colours are smoothed, which has a test of its own
// (vessel_smoothing_test.cpp).
constexpr double least_smoothed_px = 1.6;

struct Disagreement {
  int compared = 0;    // pixels that are well inside or outside every outline
  int in_coverage = 0; // of these
  int in_depth = 0;    // by more than rounding
  int unsmoothed = 0;  // those that no outline is near
  int in_colour = 0;   // of these, by more than rounding
};

Disagreement compare(const ui::VesselScene& scene, const DrawnVessels& a, const DrawnVessels& b) {
  const auto reference = reference_vessels(scene);
  Disagreement found;
  for (std::size_t i = 0; i < reference.size(); ++i) {
    if (reference[i].to_outline_px < 0.01)
      continue;
    ++found.compared;
    found.in_coverage += a.covered(i) != b.covered(i);
    found.in_depth += std::abs(distance_mm(scene.camera, a.depth[i]) -
                               distance_mm(scene.camera, b.depth[i])) > 0.001;
    if (reference[i].to_outline_px < least_smoothed_px)
      continue;
    ++found.unsmoothed;
    int colour = 0;
    for (std::size_t channel = 3 * i; channel < 3 * i + 3; ++channel)
      colour = std::max(colour, std::abs(int{a.colour.pixels[channel]} - b.colour.pixels[channel]));
    found.in_colour += colour > 1;
  }
  return found;
}

class VesselAgreement : public GlTest {
protected:
  void SetUp() override { open(VesselStage::width, VesselStage::height); }

  // Around the tree, the second time amidst it.
  static std::vector<ui::VesselView> views_of(const VesselStage& stage) {
    std::vector<ui::VesselView> views(4, stage.whole());
    views[1].yaw_deg = 160;
    views[1].tilt_deg = -50;
    views[1].mm_per_pixel /= 1.5F;
    views[2].tilt_deg = 90;
    views[3].mm_per_pixel /= 2.2F;
    views[3].target_mm = {1, 0, 0};
    return views;
  }
};

TEST_F(VesselAgreement, hybrid_is_quads_where_nothing_is_smoothed) {
  VesselStage stage{random_tree(12000, 31)};
  for (const float gl_radius_px : {processor_only, 1.5F, 0.3F}) {
    ui::HybridMethod hybrid = make_hybrid(gl_radius_px);
    for (const ui::VesselView& view : views_of(stage))
      for (const auto colouring : {ui::VesselColouring::branch, ui::VesselColouring::order}) {
        const ui::VesselScene scene = stage.scene(view, colouring);
        const DrawnVessels quads = stage.draw(stage.method(VesselMethodKind::quads_gpu), scene);
        const DrawnVessels drawn = stage.draw(hybrid, scene);
        EXPECT_EQ(drawn.account.total(), stage.tree().segments);
        EXPECT_EQ(drawn.account.drawn > 0, gl_radius_px != processor_only);
        EXPECT_GT(drawn.account.splatted, 0U);
        const Disagreement found = compare(scene, drawn, quads);
        EXPECT_GT(found.compared, 30000);
        EXPECT_EQ(found.in_coverage, 0) << gl_radius_px << ' ' << view.yaw_deg;
        // Where two are as good as equally near: wide ones share the ball at a joint, and rounding
        // decides whose light is seen there.
        EXPECT_GT(found.unsmoothed, 3000);
        EXPECT_LE(found.in_colour, found.unsmoothed / 150) << gl_radius_px << ' ' << view.yaw_deg;
      }
  }
}

// From a pixel on: below, quads do not keep the depth flat in the round ends.
TEST_F(VesselAgreement, hybrid_has_the_depth_of_quads) {
  pipeline::VesselTree tree = random_tree(4000, 33);
  for (float& radius : tree.radii_mm)
    radius = std::max(radius, 0.18F);
  VesselStage stage{tree};
  for (const float gl_radius_px : {processor_only, 2.2F}) {
    ui::HybridMethod hybrid = make_hybrid(gl_radius_px);
    for (ui::VesselView view : views_of(stage)) {
      view.mm_per_pixel = stage.whole().mm_per_pixel;
      const ui::VesselScene scene = stage.scene(view);
      const DrawnVessels quads = stage.draw(stage.method(VesselMethodKind::quads_gpu), scene);
      const Disagreement found = compare(scene, stage.draw(hybrid, scene), quads);
      EXPECT_GT(found.compared, 30000);
      EXPECT_EQ(found.in_coverage, 0);
      EXPECT_LE(found.in_depth, 3) << gl_radius_px << ' ' << view.yaw_deg;
    }
  }
}

TEST_F(VesselAgreement, what_is_kept_visible_is_a_pixel_wide_whoever_draws_it) {
  pipeline::VesselTree tree = random_tree(1500, 32);
  for (std::size_t i = 0; i < tree.nodes(); ++i)
    tree.orders[i] = tree.branches[i] == pipeline::VesselBranch::rca ? 5 : 4;
  for (float& radius : tree.radii_mm)
    radius *= 0.02F;
  VesselStage stage{tree};
  const ui::VesselScene scene = stage.scene(stage.whole());
  const auto reference = reference_vessels(scene);
  const auto covered = std::ranges::count_if(reference, &ReferenceVesselPixel::covered);
  ASSERT_GT(covered, 200);
  for (const VesselMethodKind kind : ui::all_vessel_methods) {
    const bool tubes = kind == VesselMethodKind::tubes_gpu || kind == VesselMethodKind::tubes_cpu;
    const DrawnVessels drawn = stage.draw(stage.method(kind), scene);
    for (std::size_t i = 0; i < reference.size(); ++i)
      if (std::abs(reference[i].inside_px) > (tubes ? 0.3 : 0.01)) {
        ASSERT_EQ(drawn.covered(i), reference[i].covered())
            << to_string(kind) << " at " << i << ", by " << reference[i].inside_px;
      }
  }
}

} // namespace
} // namespace octascope::tests
