// What flows, told while the appliance runs.
#include <fstream>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/program/program_support.h"

namespace octascope::tests {
namespace {

using nlohmann::json;

// 320 ms for 12 B-scans of two sweeps each: other tests have the processors, too.
std::string flow_configuration(const std::string& more_pipeline) {
  return R"([scan]
samples = 512
a_scans = 128
fly_back_lines = 32
b_scans = 12
repeats = 2
line_rate_hz = 12000
depth_spacing_um = 7
a_spacing_um = 10
b_spacing_um = 50
[sim]
phantom = "perfused"
loop_volumes = 2
[pipeline]
workers = 1
)" + more_pipeline;
}

json run_with_flow(const std::string& more_pipeline, const std::vector<std::string>& more) {
  const ScratchFolder folder;
  const std::string report_file = folder / "report.json";
  std::vector<std::string> words{
      "run",       "--sim",
      "--config",  folder.write("flow.toml", flow_configuration(more_pipeline)),
      "--display", "offscreen",
      "--size",    fmt::format("{}x{}", small_width, small_height),
      "--volumes", "12",
      "--report",  report_file};
  words.insert(words.end(), more.begin(), more.end());
  run_well(words);
  return read_report(report_file);
}

TEST(LiveFlow, every_volume_has_it_and_nothing_is_lost) {
  const json report = run_with_flow("flow = true\n", {});
  expect_nothing_lost(report);
  const json& flow = report.at("flow");
  const json& b_scans = flow.at("b_scans");
  const int told = b_scans.at("told"), none = b_scans.at("none");
  const int published = report["volumes"]["published"];
  EXPECT_EQ(b_scans.at("left_out"), 0);
  EXPECT_EQ(told + none, 12 * published);
  EXPECT_GT(flow["angiograms"], 6);
  // Where other programs took the workers' time, some of it is given up, and counted.
  if (report["lost"]["lines"] == 0 && b_scans.at("no_time") == 0) {
    EXPECT_EQ(flow["angiograms"], published);
    EXPECT_NEAR(flow.at("angiograms_per_s").get<double>(),
                published / report["duration_s"].get<double>(), 0.01);
    EXPECT_EQ(none, 0);
  }
  EXPECT_GT(flow.at("ms").at("p50"), 0);
  EXPECT_EQ(report["hot_path"]["allocations"], 0);
}

TEST(LiveFlow, the_command_line_comes_before_the_configuration) {
  EXPECT_TRUE(run_with_flow("flow = true\n", {"--flow", "off"}).at("flow").is_null());
  EXPECT_TRUE(run_with_flow("", {}).at("flow").is_null());
  EXPECT_TRUE(run_with_flow("", {"--flow", "on"}).at("flow").is_object());
}

TEST(LiveFlow, plans_that_cannot_tell_it_are_refused_with_what_to_do) {
  const auto refusal = [](std::vector<std::string> more) {
    std::vector<std::string> words{"run",       "--sim",     "--flow",    "on",
                                   "--display", "offscreen", "--volumes", "1"};
    words.insert(words.end(), more.begin(), more.end());
    const auto run = run_octascope(words);
    EXPECT_NE(run.exit_status, 0);
    return run.err;
  };
  EXPECT_THAT(refusal({}), testing::HasSubstr("repeats is 1, expected 2 to 4; --repeats 2"));
  EXPECT_THAT(refusal({"--repeats", "2", "--bidirectional"}),
              testing::HasSubstr("leave out --bidirectional"));
}

} // namespace
} // namespace octascope::tests
