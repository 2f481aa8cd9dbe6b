// What octascope bench chain says of its conditions and figures.
#include <gtest/gtest.h>

#include "tests/program/program_support.h"

namespace octascope::tests {
namespace {

using nlohmann::json;

// The first of its measurements; for the others there is no time.
TEST(BenchChain, tells_figures_with_their_conditions_and_quality) {
  const json told = json::parse(
      run_well({"bench", "chain", "--json", "--seconds", "0.1", "--size", "160x90"}).out);
  EXPECT_NE(told.at("cpu"), "");
  EXPECT_GE(told.at("cores"), 1);
  EXPECT_EQ(told.at("display"), "offscreen, 160x90");
  EXPECT_GT(told.at("run_s").at("with_display"), 0);
  EXPECT_GT(told.at("run_s").at("at_given_rates"), 0);
  EXPECT_GT(told.at("run_s").at("without"), 0);
  for (const char* key : {"reconstruct_only", "with_display"})
    EXPECT_EQ(told.at("highest_line_rate_hz").at(key), 0) << key << ": none was looked for";
  ASSERT_EQ(told.at("cases").size(), 1);
  const json& first = told["cases"][0];
  EXPECT_EQ(first.at("samples"), 1024);
  EXPECT_EQ(first.at("a_scans"), 300);
  EXPECT_EQ(first.at("b_scans"), 80);
  EXPECT_EQ(first.at("mode"), "whole");
  EXPECT_EQ(first.at("display"), true);
  EXPECT_EQ(first.at("line_rate_hz"), 215e3);
  EXPECT_EQ(first.at("rate"), "given");
  EXPECT_TRUE(first.at("lost_lines").is_number_unsigned());
  EXPECT_GT(first.at("volumes_per_s"), 0);
  EXPECT_LE(first.at("shown_per_s"), first.at("volumes_per_s"));
  EXPECT_GT(first.at("frames_per_s"), 0);
  EXPECT_GE(first.at("stolen"), 0);
  if (first["shown_per_s"] == 0)
    GTEST_SKIP() << "nothing was shown in so short a time";
  for (const char* key : {"latency_ms", "line_latency_ms"}) {
    const json& latency = first.at(key);
    EXPECT_GT(latency.at("p50"), 0) << key;
    EXPECT_LE(latency.at("p50"), latency.at("p95")) << key;
    EXPECT_LE(latency.at("p95"), latency.at("p99")) << key;
  }
  const json& quality = first.at("quality");
  EXPECT_GT(quality.at("frames"), 0);
  for (const char* key : {"resolution", "steps"}) {
    EXPECT_GT(quality.at(key).at("worst"), 0) << key;
    EXPECT_LE(quality.at(key).at("worst"), quality.at(key).at("median")) << key;
  }
}

} // namespace
} // namespace octascope::tests
