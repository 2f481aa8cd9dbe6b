// octascope bench flow as a user runs it: that flow and vessels are as good as they are said to be.
#include <gtest/gtest.h>

#include "tests/program/program_support.h"

namespace octascope::tests {
namespace {

using nlohmann::json;

TEST(BenchFlow, flow_in_spectra_agrees_with_the_truth) {
  const json told = json::parse(run_well({"bench", "flow", "--b-scans", "24", "--json"}).out);
  EXPECT_EQ(told.at("phantom"), "perfused");
  EXPECT_EQ(told.at("b_scans"), 24);
  EXPECT_EQ(told.at("axial_motion"), json::parse("[[10.0, 20.0]]"));
  EXPECT_GT(told.at("motion_between_repeats_um"), 1);
  ASSERT_EQ(told.at("cases").size(), 4);
  for (const json& one : told["cases"]) {
    const bool four = one.at("repeats") == 4;
    const bool complex = one.at("method") == "complex";
    SCOPED_TRACE(one.dump());
    EXPECT_GT(one.at("voxels"), 1'000'000);
    EXPECT_GE(one.at("told_share"), 0.8);
    EXPECT_GE(one.at("auc"), four ? 0.95 : 0.9);
    EXPECT_LE(one.at("auc"), 1);
    EXPECT_LE(one.at("false_positive_share"), 0.02);
    EXPECT_GT(one.at("false_positive_share"), 0);
    EXPECT_EQ(one.at("left_out_b_scans"), 0);
    const json& by_radius = one.at("detected_share_by_radius_um");
    ASSERT_EQ(by_radius.size(), 6);
    EXPECT_GT(by_radius.at("30-45"), by_radius.at("0-7"));
    if (!complex) {
      EXPECT_TRUE(one.at("live").is_null());
      continue;
    }
    const json& live = one.at("live");
    EXPECT_EQ(live.at("line_rate_hz"), four ? 860e3 : 215e3);
    EXPECT_GT(live.at("compared_share"), 0) << "all of them where the machine is quick enough";
    EXPECT_LE(one["angiograms_per_s"], live.at("planned_per_s"));
    EXPECT_TRUE(one.at("lost_lines").is_number()) << "how many depends on the machine";
    EXPECT_GE(one.at("detected_share"), 0.8);
    EXPECT_GE(one.at("tree").at("found_share"), 0.9);
    EXPECT_LE(one["tree"].at("invented_share"), 0.05);
    const json& error = one.at("centreline_error_um");
    EXPECT_LT(error.at("p50"), error.at("p95"));
    // Of 4.5 mm of vessels; over the whole field they are smaller (docs/ANGIOGRAPHY.md).
    EXPECT_LE(error.at("p95_along_a_scans"), 20);
    EXPECT_LE(error.at("p95_along_b_scans"), 55);
    EXPECT_LE(error.at("p95_along_depth"), 22);
  }
}

TEST(BenchFlow, text_has_a_line_a_case_and_says_what_was_refused) {
  const std::string out = run_well({"bench", "flow", "--b-scans", "1", "--repeats", "3"}).out;
  EXPECT_NE(out.find("1 B-scans, 215 kHz"), std::string::npos) << out;
  EXPECT_NE(out.find("\n      3  complex"), std::string::npos) << out;
  EXPECT_NE(out.find("\n      3  intensity"), std::string::npos) << out;
  EXPECT_NE(out.find("refused: "), std::string::npos) << out;
  EXPECT_NE(out.find("\n      3     215 kHz"), std::string::npos) << out;
}

} // namespace
} // namespace octascope::tests
