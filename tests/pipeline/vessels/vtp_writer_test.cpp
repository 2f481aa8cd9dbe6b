// Vessel trees to VTK's files and back.
#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/vessels/files/vtp_reader.h"
#include "pipeline/vessels/files/vtp_writer.h"
#include "pipeline/vessels/tree_comparison.h"
#include "pipeline/vessels/tree_summary.h"
#include "tests/support/fails_with.h"
#include "tests/support/files/scratch_folder.h"
#include "tests/support/must.h"
#include "tests/support/vessels/flow_scene.h"

namespace octascope::pipeline {
namespace {

using tests::add_tube;

class VtpWriter : public testing::Test {
protected:
  VtpTree written_and_read(const VesselTree& tree) {
    const auto written = write_vtp(folder / "tree.vtp", tree);
    EXPECT_TRUE(written) << written.error().message;
    TreeReadOptions options;
    options.forest = true;
    return tests::must(read_vtp(folder / "tree.vtp", options));
  }

  tests::ScratchFolder folder;
};

// As a tracing gives them: a trunk that forks twice, and a vessel by itself.
VesselTree trunk_and_stray() {
  VesselTree tree;
  const auto trunk = add_tube(tree, {0, 950, 550}, {700, 950, 550}, 50);
  const auto left = add_tube(tree, {700, 950, 550}, {1300, 550, 480}, 40, trunk);
  add_tube(tree, {700, 950, 550}, {1300, 1350, 650}, 35.5, trunk);
  add_tube(tree, {1300, 550, 480}, {2000, 550, 450}, 30, left);
  add_tube(tree, {1300, 550, 480}, {1700, 0, 600}, 20, left);
  add_tube(tree, {100, 100, 100}, {100, 1800, 133.3}, 12.25);
  return tree;
}

// A node for each, its radius and its parent's place to the last bit, in whatever sequence.
using PlacedNode = std::array<float, 7>;
std::vector<PlacedNode> nodes_of(const VesselTree& tree) {
  std::vector<PlacedNode> nodes;
  for (std::size_t i = 0; i < tree.nodes(); ++i) {
    const auto& at = tree.positions_mm[i];
    const auto& from = tree.positions_mm[tree.parents[i] == no_parent ? i : tree.parents[i]];
    nodes.push_back({at[0], at[1], at[2], from[0], from[1], from[2], tree.radii_mm[i]});
  }
  std::ranges::sort(nodes);
  return nodes;
}

TEST_F(VtpWriter, writes_what_is_read_back_to_the_last_bit) {
  const VesselTree tree = trunk_and_stray();
  const VtpTree found = written_and_read(tree);
  EXPECT_EQ(nodes_of(found.tree), nodes_of(tree));
  EXPECT_EQ(found.counts.lines, 6U);
  EXPECT_EQ(found.counts.roots, 2U);
  EXPECT_EQ(found.counts.merged_points, 0U);
  EXPECT_EQ(found.counts.unused_points, 0U);
}

TEST_F(VtpWriter, writes_what_others_read) {
  VesselTree tree;
  tree.positions_mm = {{0, 0, 0}, {0.0125F, -1.5F, 2}, {1, 1, 3}};
  tree.radii_mm = {0.1F, 0.0045F, 0.25F};
  tree.parents = {no_parent, 0, 0};
  tree.orders = {11, 10, 10};
  tree.branches = {VesselBranch::lad, VesselBranch::unknown, VesselBranch::unknown};
  ASSERT_TRUE(write_vtp(folder / "tree.vtp", tree));
  EXPECT_EQ(tests::whole_file(folder / "tree.vtp"),
            "<?xml version=\"1.0\"?>\n"
            "<VTKFile type=\"PolyData\" version=\"0.1\" byte_order=\"LittleEndian\">\n"
            "<PolyData>\n"
            "<Piece NumberOfPoints=\"3\" NumberOfVerts=\"0\" NumberOfLines=\"2\" "
            "NumberOfStrips=\"0\" NumberOfPolys=\"0\">\n"
            "<PointData Scalars=\"Radius\">\n"
            "<DataArray type=\"Float32\" Name=\"Radius\" format=\"ascii\">\n"
            "0.1 0.0045 0.25\n</DataArray>\n"
            "</PointData>\n<Points>\n"
            "<DataArray type=\"Float32\" Name=\"Points\" NumberOfComponents=\"3\" "
            "format=\"ascii\">\n0 0 0 0.0125 -1.5 2 1 1 3\n</DataArray>\n"
            "</Points>\n<Lines>\n"
            "<DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">\n"
            "0 1 0 2\n</DataArray>\n"
            "<DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">\n"
            "2 4\n</DataArray>\n"
            "</Lines>\n</Piece>\n</PolyData>\n</VTKFile>\n");
}

TEST_F(VtpWriter, refuses_what_could_not_be_read_back) {
  using tests::FailsWith;
  VesselTree tree = trunk_and_stray();
  tree.radii_mm[3] = std::nanf("");
  EXPECT_THAT(write_vtp(folder / "tree.vtp", tree),
              FailsWith(hal::ErrorCode::invalid_argument, "node 3 with a place or radius"));
  VesselTree root;
  tests::add_node(root, {0, 0, 0}, 10, no_parent);
  EXPECT_THAT(write_vtp(folder / "tree.vtp", root),
              FailsWith(hal::ErrorCode::invalid_argument, "found 1 nodes without a segment"));
  EXPECT_FALSE(std::filesystem::exists(folder / "tree.vtp"));
}

} // namespace
} // namespace octascope::pipeline
