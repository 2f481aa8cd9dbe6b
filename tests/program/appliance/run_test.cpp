// A run as a user starts it: picture, report, and its end by Ctrl-C.
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <numeric>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/program/program_support.h"

namespace octascope::tests {
namespace {

using nlohmann::json;
using namespace std::chrono_literals;

// Every key that the report promises, with its type.
void expect_contract(const json& report) {
  EXPECT_TRUE(report.at("simulated").is_boolean());
  for (const char* device :
       {"line_camera", "galvo_trigger", "control_input", "scope_camera", "display"})
    EXPECT_TRUE(report.at("devices").at(device).is_string()) << device;
  for (const char* key : {"acquired", "published", "displayed", "skipped"})
    EXPECT_TRUE(report.at("volumes").at(key).is_number_unsigned()) << key;
  for (const char* key : {"lines", "b_scans", "volumes"})
    EXPECT_TRUE(report.at("lost").at(key).is_number_unsigned()) << key;
  for (const char* key : {"lines_per_s", "volumes_per_s", "shown_volumes_per_s", "frames_per_s"})
    EXPECT_TRUE(report.at("rates").at(key).is_number_float()) << key;
  const auto expect_durations = [](const json& durations) {
    EXPECT_GE(durations.at("p50").get<double>(), 0);
    EXPECT_LE(durations.at("p50").get<double>(), durations.at("p95").get<double>());
    EXPECT_LE(durations.at("p95").get<double>(), durations.at("p99").get<double>());
    EXPECT_LE(durations.at("p99").get<double>(), durations.at("max").get<double>());
  };
  for (const char* stage : {"reconstruct", "assemble", "publish", "upload", "draw"})
    expect_durations(report.at("stage_ms").at(stage));
  expect_durations(report.at("latency_ms"));
  const json& quality = report.at("quality");
  for (const char* key : {"resolution", "steps"}) {
    if (quality.at("frames") == 0) { // a run may end before its first volume
      EXPECT_TRUE(quality.at(key).is_null()) << key;
      continue;
    }
    EXPECT_GT(quality.at(key).at("worst").get<double>(), 0) << key;
    EXPECT_LE(quality.at(key).at("worst"), quality.at(key).at("median")) << key;
  }
  EXPECT_LE(quality.at("frames"), report.at("frames").at("drawn"));
  for (const char* key : {"drawn", "missed"})
    EXPECT_TRUE(report.at("frames").at(key).is_number_unsigned()) << key;
  EXPECT_TRUE(report.at("hot_path").at("allocations").is_number_unsigned());
  EXPECT_TRUE(report.at("faults").is_array());
}

double mean_of(const pipeline::Image& picture) {
  return std::accumulate(picture.pixels.begin(), picture.pixels.end(), 0.0) /
         static_cast<double>(picture.pixels.size());
}

TEST(Run, leaves_a_whole_report_and_a_picture) {
  const ScratchFolder folder;
  const std::string snapshot = folder / "picture.png";
  const std::string report_file = folder / "report.json";
  // Sanitized, the full line rate is out of reach, and maybe the first volume in three seconds.
  std::vector<std::string> arguments{"run", "--sim"};
  if (sanitized)
    arguments.insert(arguments.end(),
                     {"--config", write_small_configuration(folder), "--volumes", "8"});
  else
    arguments.insert(arguments.end(), {"--duration", "3"});
  arguments.insert(arguments.end(), {"--display", "offscreen", "--size", "320x180", "--snapshot",
                                     snapshot, "--report", report_file});
  const ProgramResult result = run_well(arguments);
  EXPECT_EQ(result.err, "") << "no terminal, no status line";
  EXPECT_THAT(result.out, testing::HasSubstr("volumes displayed"));
  EXPECT_THAT(result.out, testing::HasSubstr(report_file));
  EXPECT_THAT(result.out, testing::HasSubstr(snapshot));

  const pipeline::Image picture = read_snapshot(snapshot);
  EXPECT_EQ(picture.width, 320);
  EXPECT_EQ(picture.height, 180);
  EXPECT_GT(mean_of(picture), 10);

  const json report = read_report(report_file);
  ASSERT_NO_THROW(expect_contract(report));
  EXPECT_EQ(report["simulated"], true);
  EXPECT_EQ(report["devices"]["line_camera"], "sim");
  EXPECT_EQ(report["devices"]["display"], "offscreen");
  EXPECT_GE(report["volumes"]["displayed"], 1);
  EXPECT_LE(report["volumes"]["displayed"], report["volumes"]["published"]);
  EXPECT_EQ(report["volumes"]["published"], report["volumes"]["acquired"]);
  EXPECT_GE(report["frames"]["drawn"], report["volumes"]["displayed"]);
  EXPECT_GT(report["rates"]["lines_per_s"], 0);
  EXPECT_GT(report["latency_ms"]["p50"], 0);
  // What was lost is told: on a machine that is not ours alone the full rate may cost a B-scan,
  // and then there is a fault that says why.
  if (report["lost"]["b_scans"] == 0) {
    EXPECT_EQ(report["lost"], (json{{"lines", 0}, {"b_scans", 0}, {"volumes", 0}}));
    EXPECT_EQ(report["hot_path"]["allocations"], 0);
  } else {
    EXPECT_TRUE(std::ranges::any_of(report["faults"], [](const json& fault) {
      return fault["device"] == "pipeline" || fault["device"] == "line_camera" ||
             fault["device"] == "galvo_trigger";
    })) << report.dump(2);
  }
}

TEST(Run, small_scene_loses_nothing) {
  const ScratchFolder folder;
  const std::string report_file = folder / "report.json";
  run_well(small_run(folder, {"--volumes", "5", "--report", report_file}));
  const json report = read_report(report_file);
  EXPECT_EQ(report["volumes"]["published"], 5);
  EXPECT_EQ(report["volumes"]["displayed"].get<int>() + report["volumes"]["skipped"].get<int>(), 5);
  expect_nothing_lost(report);
}

class RunEnds : public testing::TestWithParam<int> {};

TEST_P(RunEnds, at_once_by_a_signal_with_report_and_picture) {
  const ScratchFolder folder;
  const std::string snapshot = folder / "picture.png";
  const std::string report_file = folder / "report.json";
  ProgramRun run{octascope_command(
      small_run(folder, {"--duration", "100", "--snapshot", snapshot, "--report", report_file}))};
  ASSERT_TRUE(run.wait_for_thread("octa-camera", 60s));
  std::this_thread::sleep_for(1s); // some volumes
  const auto signalled = WallClock::now();
  run.send_signal(GetParam());
  const ProgramResult result = run.wait(60s);
  const auto took = std::chrono::duration<double>(WallClock::now() - signalled);
  std::printf("ended %.2f s after the signal\n", took.count());
  EXPECT_EQ(result.exit_status, 0) << result.describe();
  EXPECT_LT(took, sanitized ? 30s : 5s);
  EXPECT_EQ(read_snapshot(snapshot).width, small_width);
  ASSERT_NO_THROW(expect_contract(read_report(report_file)));
}

INSTANTIATE_TEST_SUITE_P(Signals, RunEnds, testing::Values(SIGINT, SIGTERM, SIGHUP),
                         [](const auto& test) { return std::string{sigabbrev_np(test.param)}; });

} // namespace
} // namespace octascope::tests
