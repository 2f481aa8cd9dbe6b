// What a benchmark of flow counts, and which vessels it measures against.
#include <limits>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "firmware-host/commands/bench/flow/flow_tally.h"
#include "firmware-host/commands/bench/flow/true_vessels.h"
#include "pipeline/vessels/tree_comparison.h"
#include "sim/phantoms/phantom.h"
#include "tests/support/must.h"

namespace octascope::firmware_host {
namespace {

constexpr float untold = std::numeric_limits<float>::quiet_NaN();

struct Voxels {
  std::vector<VoxelKind> kinds;
  std::vector<float> radii_um;
  std::vector<float> flow;

  Voxels& add(VoxelKind kind, float value, float radius_um = 0) {
    kinds.push_back(kind);
    flow.push_back(value);
    radii_um.push_back(radius_um);
    return *this;
  }
  void tally(FlowTally& tally) const { tally.add_voxels(kinds, radii_um, flow); }
};

// Two halves, as two threads count them; figures by hand.
TEST(FlowTally, counts_pairs_and_shares) {
  using enum VoxelKind;
  FlowTally tally;
  Voxels{}
      .add(still, 0.1F)
      .add(still, 0.7F)
      .add(flowing, 0.4F, 8)
      .add(flowing, untold, 8)
      .add(left_out, 1)
      .tally(tally);
  FlowTally other;
  Voxels{}
      .add(still, 0.2F)
      .add(still, 0.4F)
      .add(still, untold)
      .add(flowing, 0.9F, 8)
      .add(flowing, 0.5F, 40)
      .tally(other);
  tally.add(other);
  const FlowFigures figures = std::move(tally).figures();
  EXPECT_EQ(figures.voxels, 9U);
  // Of the 12 pairs, 0.9 is above four, 0.5 above three, 0.4 above two and as high as one.
  EXPECT_DOUBLE_EQ(figures.auc, 9.5 / 12);
  EXPECT_DOUBLE_EQ(figures.told_share, 7.0 / 9);
  EXPECT_DOUBLE_EQ(figures.false_positive_share, 1.0 / 4);
  EXPECT_DOUBLE_EQ(figures.detected_share, 2.0 / 4);
  EXPECT_EQ(figures.flowing_by_radius[1], 3U);
  EXPECT_DOUBLE_EQ(figures.detected_by_radius[1], 1.0 / 3);
  EXPECT_DOUBLE_EQ(figures.detected_by_radius[5], 1);
}

TEST(TrueVessels, are_cut_off_at_the_border_and_otherwise_the_phantoms_tree) {
  const auto phantom = tests::must(sim::make_phantom("perfused", 1));
  pipeline::VolumeGeometry field = phantom->suggested_plan().geometry();
  const auto total_length = [](const pipeline::VesselTree& tree) {
    return pipeline::compare_trees({}, tree, {}).true_length_mm;
  };
  double whole = 0;
  for (const int b_scans : {80, 20}) {
    field.b_scans = b_scans;
    const pipeline::VesselTree tree = vessels_within(field, *phantom);
    int at_border = 0;
    for (const auto& [x, y, z] : tree.positions_mm) {
      EXPECT_GE(x, -1e-5F);
      EXPECT_GE(y, -1e-5F);
      EXPECT_LE(static_cast<double>(x), field.a_mm() + 1e-5);
      EXPECT_LE(static_cast<double>(y), field.b_mm() + 1e-5);
      at_border += y < 1e-5F || static_cast<double>(y) > field.b_mm() - 1e-5 ? 1 : 0;
    }
    EXPECT_GT(at_border, 0);
    const double length = total_length(tree);
    if (b_scans == 80)
      whole = length;
    else
      EXPECT_LT(length, 0.5 * whole);
    EXPECT_GT(length, 5);
  }
}

} // namespace
} // namespace octascope::firmware_host
