// Vessel trees as clusters, from files of every kind.
#include <algorithm>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "firmware-host/vessels/vessel_files.h"
#include "firmware-host/vessels/vessel_source.h"
#include "pipeline/vessels/clusters/cluster_unpacker.h"
#include "tests/support/fails_with.h"
#include "tests/support/files/scratch_folder.h"
#include "tests/support/must.h"
#include "tests/support/vessels/random_tree.h"
#include "tests/support/vessels/same_tree.h"

namespace octascope::firmware_host {
namespace {

class VesselSource : public testing::Test {
protected:
  void expect_the_tree(const LoadedVessels& loaded) const {
    EXPECT_EQ(loaded.clusters().segments, 3000U);
    EXPECT_EQ(loaded.facts().roots, 3U);
    EXPECT_EQ(loaded.facts().nodes, 3003U);
    EXPECT_GT(loaded.bytes(), 3000U * 8);
    EXPECT_LT(loaded.bytes(), 3000U * 10);
    const auto unpacked = tests::must(pipeline::unpack_tree(loaded.clusters()));
    tests::TreeComparison comparison{tree_, unpacked};
    EXPECT_EQ(comparison.run(), "");
    EXPECT_LE(comparison.error().position_um, loaded.facts().error.position_um * 1.01F);
  }

  pipeline::VesselTree tree_ = tests::random_tree(3000, 8);
  tests::ScratchFolder folder_;
};

TEST_F(VesselSource, maps_our_own_format) {
  ASSERT_TRUE(write_tree(folder_ / "tree", tree_, "by lot"));
  auto loaded = tests::must(load_vessels(folder_ / "tree"));
  EXPECT_TRUE(loaded.is_mapped());
  EXPECT_EQ(loaded.facts().provenance, "by lot");
  const LoadedVessels moved = std::move(loaded);
  expect_the_tree(moved);
}

TEST_F(VesselSource, packs_swc) {
  ASSERT_TRUE(write_tree(folder_ / "tree.swc", tree_, "by lot"));
  std::vector<double> told;
  pipeline::TreeReadOptions options;
  options.progress = [&](double done) { told.push_back(done); };
  auto loaded = tests::must(load_vessels(folder_ / "tree.swc", options));
  EXPECT_FALSE(loaded.is_mapped());
  EXPECT_EQ(loaded.facts().provenance, "tree.swc");
  const LoadedVessels moved = std::move(loaded);
  expect_the_tree(moved);
  EXPECT_TRUE(std::ranges::is_sorted(told));
  EXPECT_EQ(told.back(), 1);
}

TEST_F(VesselSource, says_what_is_wrong_with_a_file) {
  EXPECT_THAT(load_vessels(folder_.write("bad.swc", "1 0 0 0 0 zero -1\n")),
              tests::FailsSaying("bad.swc:1:11: found"));
  const auto absent = load_vessels(folder_ / "absent");
  ASSERT_FALSE(absent);
  EXPECT_EQ(absent.error().code, hal::ErrorCode::absent);
}

} // namespace
} // namespace octascope::firmware_host
