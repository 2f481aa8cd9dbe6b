// octascope vessels generate as a user runs it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/program/program_support.h"

namespace octascope::tests {
namespace {

using nlohmann::json;
using testing::HasSubstr;

TEST(VesselsGenerate, writes_a_tree_that_info_reads) {
  const ScratchFolder folder;
  const ProgramResult made = run_well({"vessels", "generate", "--segments", "1500", "--seed", "3",
                                       "--out", folder / "heart.swc", "--json"});
  const json table = json::parse(made.out);
  EXPECT_EQ(table["segments"], 1500);
  EXPECT_EQ(table["lowest_order"], 8);
  EXPECT_EQ(table["table"][0]["branch"], "RCA");
  EXPECT_EQ(table["table"][0]["elements"]["achieved"], 1);
  const ProgramResult read = run_octascope(
      {"vessels", "info", folder / "heart.swc", "--unit", "um", "--json"}); // says it is a forest
  ASSERT_EQ(read.exit_status, 0) << read.describe();
  EXPECT_EQ(json::parse(read.out)["segments"], 1500);
  EXPECT_EQ(json::parse(read.out)["roots"], 3);
  EXPECT_EQ(json::parse(read.out)["table"], table["table"]);
}

TEST(VesselsGenerate, writes_our_own_format_that_info_tells_in_full) {
  const ScratchFolder folder;
  const ProgramResult made = run_well(
      {"vessels", "generate", "--segments", "60000", "--out", folder / "heart.vessels", "--json"});
  const ProgramResult read = run_well({"vessels", "info", folder / "heart.vessels", "--json"});
  EXPECT_EQ(read.err, "");
  const json told = json::parse(read.out);
  expect_all(told, json::parse(R"({
    "kind": "vessels", "unit": "mm", "segments": 60000, "nodes": 60003, "roots": 3,
    "lone_roots": 0, "coincident": 0, "checksums": "good",
    "provenance": "octascope vessels generate --segments 60000 --seed 1"
  })"));
  EXPECT_EQ(told["bytes"], std::filesystem::file_size(folder / "heart.vessels"));
  EXPECT_LE(told["bytes_a_segment"], 9.0);
  EXPECT_GT(told["position_error_um"], 0.0);
  const json grown = json::parse(made.out)["table"];
  ASSERT_EQ(told["table"].size(), grown.size());
  for (std::size_t i = 0; i < grown.size(); ++i) {
    EXPECT_EQ(told["table"][i]["segments"], grown[i]["segments"]);
    EXPECT_EQ(told["table"][i]["elements"]["achieved"], grown[i]["elements"]["achieved"]);
    EXPECT_NEAR(told["table"][i]["diameter_um"]["z"].get<double>(),
                grown[i]["diameter_um"]["z"].get<double>(), 0.01);
  }
  const ProgramResult text = run_octascope({"vessels", "info", folder / "heart.vessels"});
  EXPECT_THAT(text.out, HasSubstr("from: octascope vessels generate --segments 60000 --seed 1"));
  EXPECT_THAT(text.out, HasSubstr("RCA 11"));
  EXPECT_THAT(text.out, HasSubstr("Murray"));
}

TEST(VesselsGenerate, refuses_a_number_out_of_range) {
  const ScratchFolder folder;
  const ProgramResult result =
      run_octascope({"vessels", "generate", "--segments", "999", "--out", folder / "heart.swc"});
  EXPECT_EQ(result.exit_status, 2);
  EXPECT_THAT(result.err, HasSubstr("999 segments asked for, expected 1000 to 20000000"));
  EXPECT_TRUE(listing(folder.path()).empty());
}

} // namespace
} // namespace octascope::tests
