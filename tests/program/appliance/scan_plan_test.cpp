// Scan plans as a user asks for them: there and back, repeats, workers on their cores.
#include <fstream>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/program/program_support.h"

namespace octascope::tests {
namespace {

using nlohmann::json;

// 160 ms for 24 B-scans of 96 A-scans there and back, 190 ms with fly-back: any machine keeps up,
// and there is enough to be seen for the phase offset to be found. The mirror lags by 3.3 lines.
std::string scan_configuration(const std::string& more_scan) {
  return R"([scan]
samples = 256
a_scans = 96
fly_back_lines = 24
turn_around_lines = 4
b_scans = 24
line_rate_hz = 15000
depth_spacing_um = 18
a_spacing_um = 100
b_spacing_um = 200
)" + more_scan +
         R"([pipeline]
workers = 1
[sim]
loop_volumes = 2
galvo_lag_us = 220
)";
}

json run_scan(const std::string& more_scan, std::vector<std::string> more, int volumes) {
  const ScratchFolder folder;
  const std::string report_file = folder / "report.json";
  std::vector<std::string> words{
      "run",       "--sim",
      "--config",  folder.write("scan.toml", scan_configuration(more_scan)),
      "--display", "offscreen",
      "--size",    fmt::format("{}x{}", small_width, small_height),
      "--volumes", std::to_string(volumes),
      "--report",  report_file};
  words.insert(words.end(), more.begin(), more.end());
  run_well(words);
  return read_report(report_file);
}

TEST(ScanPlans, there_and_back_finds_its_offset_and_gains_the_fly_backs_time) {
  const json there = run_scan("", {}, 20);
  const json both = run_scan("", {"--bidirectional"}, 20);
  EXPECT_EQ(there["scan"]["bidirectional"], false);
  EXPECT_EQ(both["scan"]["bidirectional"], true);
  EXPECT_EQ(both["scan"]["lines_per_sweep"], 100);
  EXPECT_GE(both["scan"]["planned_volumes_per_s"].get<double>(),
            1.19 * there["scan"]["planned_volumes_per_s"].get<double>());
  const json& phase = both["scan"]["phase_offset"];
  EXPECT_EQ(phase["automatic"], true);
  EXPECT_GE(phase["estimates_used"].get<int>(), 1);
  EXPECT_NEAR(phase["a_scans"].get<double>(), 3.3, 0.125) << phase;
  expect_nothing_lost(there);
  expect_nothing_lost(both);
}

TEST(ScanPlans, a_configured_offset_can_be_kept) {
  const json report = run_scan("bidirectional = true\nphase_offset_a_scans = 1.25\n"
                               "find_phase_offset = false\n",
                               {}, 6);
  EXPECT_EQ(report["scan"]["phase_offset"]["a_scans"], 1.25);
  EXPECT_EQ(report["scan"]["phase_offset"]["automatic"], false);
  EXPECT_EQ(report["scan"]["phase_offset"]["estimates_used"], 0);
}

TEST(ScanPlans, repeats_take_their_time_and_lose_nothing) {
  const json report = run_scan("", {"--repeats", "2", "--bidirectional"}, 5);
  EXPECT_EQ(report["scan"]["repeats"], 2);
  EXPECT_EQ(report["scan"]["sweeps_per_volume"], 48);
  EXPECT_NEAR(report["scan"]["planned_volumes_per_s"].get<double>(), 3.12, 0.01);
  EXPECT_EQ(report["volumes"]["published"], 5);
  expect_nothing_lost(report);
}

TEST(ScanPlans, repeats_beyond_reason_are_wrong_use) {
  EXPECT_NE(run_octascope({"run", "--sim", "--repeats", "5"}).exit_status, 0);
}

TEST(ScanPlans, workers_are_on_their_cores) {
  const json report = run_scan("", {}, 2);
  EXPECT_EQ(report["workers"]["count"], 1);
  EXPECT_GE(report["workers"]["cores"].at(0).get<int>(), 0) << "one worker always has a core";
}

} // namespace
} // namespace octascope::tests
