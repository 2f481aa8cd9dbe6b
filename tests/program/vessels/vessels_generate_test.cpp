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

// What the twin shows of a phantom and what is drawn over it lie in one place.
TEST(VesselsGenerate, writes_a_phantoms_vessels_with_their_place) {
  const ScratchFolder folder;
  for (const char* phantom : {"anterior_eye", "nail_fold", "cap"}) {
    const std::string tree = folder / (std::string{phantom} + ".VESSELS");
    const std::string place = folder / (std::string{phantom} + ".toml");
    const ProgramResult made = run_well({"vessels", "generate", "--phantom", phantom, "--out", tree,
                                         "--registration", place, "--json"});
    EXPECT_GT(json::parse(made.out)["segments"], 100) << phantom;
    const json info = json::parse(run_well({"vessels", "info", tree, "--json"}).out);
    EXPECT_EQ(info["kind"], "vessels");
    EXPECT_EQ(info["segments"], json::parse(made.out)["segments"]);
    EXPECT_EQ(info["branches"]["unknown"], info["segments"]);
    const ProgramResult drawn =
        run_well({"render", "--phantom", phantom, "--vessels", tree, "--registration", place,
                  "--size", "160x100", "--out", folder / "drawn.png"});
    EXPECT_EQ(drawn.err, "") << phantom; // registered
  }
  const ProgramResult neither = run_octascope({"vessels", "generate", "--out", folder / "x.swc"});
  EXPECT_EQ(neither.exit_status, 2);
  EXPECT_THAT(neither.err, HasSubstr("neither --segments nor --phantom"));
}

TEST(VesselsGenerate, goes_by_the_ending_in_whatever_letters) {
  const ScratchFolder folder;
  const std::string swc = folder / "heart.Swc";
  run_well({"vessels", "generate", "--segments", "1000", "--out", swc});
  EXPECT_EQ(json::parse(run_octascope({"vessels", "info", swc, "--json"}).out)["kind"], "swc");
  run_well({"vessels", "convert", swc, "--forest", "--out", folder / "heart"});
  EXPECT_EQ(json::parse(run_well({"vessels", "info", folder / "heart", "--json"}).out)["kind"],
            "vessels");
  for (const char* name : {"x.npy", "x.vtk", "x.SWC.gz"})
    for (const std::vector<std::string>& command :
         {std::vector<std::string>{"vessels", "generate", "--segments", "1000"},
          {"vessels", "generate", "--phantom", "cap"},
          {"vessels", "convert", swc, "--forest"}}) {
      std::vector<std::string> words = command;
      words.insert(words.end(), {"--out", folder / name});
      const ProgramResult refused = run_octascope(words);
      EXPECT_EQ(refused.exit_status, 2) << refused.describe();
      EXPECT_THAT(refused.err, testing::AllOf(HasSubstr(".swc"), HasSubstr(".vessels")));
    }
  EXPECT_EQ(folder.count(), 2);
}

TEST(VesselsGenerate, refuses_a_number_out_of_range) {
  const ScratchFolder folder;
  const ProgramResult result =
      run_octascope({"vessels", "generate", "--segments", "999", "--out", folder / "heart.swc"});
  EXPECT_EQ(result.exit_status, 2);
  EXPECT_THAT(result.err,
              HasSubstr("--segments: found \"999\", expected a number from 1000 to 20000000"));
  EXPECT_TRUE(listing(folder.path()).empty());
}

} // namespace
} // namespace octascope::tests
