// octascope vessels trace as a user runs it.
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/files/nrrd.h"
#include "pipeline/vessels/files/tree_file.h"
#include "pipeline/vessels/tree_comparison.h"
#include "tests/program/program_support.h"
#include "tests/support/vessels/flow_scene.h"

namespace octascope::tests {
namespace {

using nlohmann::json;
using testing::HasSubstr;

const pipeline::VolumeGeometry flow_field = oct_geometry(160, 90, 24);

pipeline::VesselTree fork() {
  pipeline::VesselTree tree;
  const auto trunk = add_tube(tree, {0, 450, 280}, {400, 450, 280}, 40);
  add_tube(tree, {400, 450, 280}, {900, 200, 250}, 30, trunk);
  add_tube(tree, {400, 450, 280}, {900, 750, 350}, 30, trunk);
  return tree;
}

std::string write_flow(const ScratchFolder& folder, std::vector<float> flow) {
  const std::string file = folder / "flow.nrrd";
  EXPECT_TRUE(pipeline::write_nrrd(file, {flow_field, std::move(flow)}));
  return file;
}

TEST(VesselsTrace, writes_a_tree_that_lies_where_the_vessels_are) {
  const ScratchFolder folder;
  const std::string flow = write_flow(folder, flow_of(fork(), flow_field));
  for (const char* name : {"tree.swc", "tree.vessels"}) {
    const std::string out = folder / name;
    const ProgramResult result = run_well({"vessels", "trace", flow, "--out", out, "--json"});
    expect_all(json::parse(result.out), {{"roots", 1}, {"branch_points", 1}, {"tips", 2}});
    const auto read = pipeline::read_tree(out);
    ASSERT_TRUE(read) << read.error().message;
    const auto found = pipeline::compare_trees(read->tree, fork(), {});
    EXPECT_GE(found.found_share, 0.95) << name;
    EXPECT_LE(found.invented_share, 0.02) << name;
    EXPECT_LE(found.axes[1].p95_um, 20) << name;
  }
}

TEST(VesselsTrace, speaks_to_people) {
  const ScratchFolder folder;
  const ProgramResult result =
      run_well({"vessels", "trace", write_flow(folder, flow_of(fork(), flow_field)), "--out",
                folder / "tree.swc"});
  EXPECT_THAT(result.out, HasSubstr("tree.swc: 1 trees, "));
  EXPECT_THAT(result.out, HasSubstr("1 branch points, 2 tips, "));
  EXPECT_THAT(result.out, HasSubstr("quality 0.9"));
}

TEST(VesselsTrace, writes_nothing_of_noise) {
  const ScratchFolder folder;
  const std::string flow = write_flow(folder, flow_of({}, flow_field, {.salt = 0.3}));
  EXPECT_THAT(run_refused(folder, {"vessels", "trace", flow, "--out", folder / "tree.swc"}),
              HasSubstr("flow.nrrd: no tree is written: "));
}

TEST(VesselsTrace, tells_other_volumes_from_flow) {
  const ScratchFolder folder;
  const auto refusal = [&](const std::string& file) {
    return run_refused(folder, {"vessels", "trace", file, "--out", folder / "tree.swc"});
  };
  EXPECT_THAT(refusal(write_flow(folder, std::vector<float>(flow_field.voxels(), 42.0F))),
              HasSubstr("found values from 0 to 42, expected flow from 0 (static) to 1 (flowing)"));
  const std::string levels = folder / "levels.nrrd";
  ASSERT_TRUE(
      pipeline::write_nrrd(levels, {flow_field, std::vector<std::uint8_t>(flow_field.voxels())}));
  EXPECT_THAT(refusal(levels), HasSubstr("found 8-bit levels, expected a flow volume"));
  const std::string bare = folder.write(
      "bare.nrrd", "NRRD0004\ntype: float\nendian: little\ndimension: 3\nsizes: 1 2 1\n"
                   "encoding: raw\n\n" +
                       std::string(8, '\0'));
  EXPECT_THAT(refusal(bare), HasSubstr("found no spacing (depth, A-scan, B-scan), expected"));
}

TEST(VesselsTrace, tells_what_of_the_file_was_assumed) {
  const ScratchFolder folder;
  const std::vector<float> flow = flow_of(fork(), flow_field);
  std::string file = "NRRD0004\ntype: float\nendian: little\ndimension: 3\nsizes: 160 90 24\n"
                     "spacings: 0.0035 0.01 0.0375\nencoding: raw\n\n";
  file.append(reinterpret_cast<const char*>(flow.data()), flow.size() * sizeof(float));
  const ProgramResult result =
      run_well({"vessels", "trace", folder.write("flow.nrrd", file), "--out", folder / "tree.swc"});
  EXPECT_THAT(result.err, HasSubstr("flow.nrrd: its spacings have no units: mm is assumed"));
}

} // namespace
} // namespace octascope::tests
