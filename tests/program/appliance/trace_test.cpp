// Where a run's time goes: stages in its report, and a trace as its viewers open it.
#include <algorithm>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

#include "tests/program/program_support.h"
#include "tests/support/program/trace_file.h"

namespace octascope::tests {
namespace {

using nlohmann::json;

class Trace : public testing::Test {
protected:
  void SetUp() override {
    run_well(small_run(folder_, {"--volumes", "8", "--report", folder_ / "report.json", "--trace",
                                 folder_ / "trace.json"}));
    report_ = read_report(folder_ / "report.json");
    rows_ = read_trace(folder_ / "trace.json");
    for (const auto& [begin, event] : rows_["display"])
      volumes_.push_back(event.at("args").at("volume"));
  }

  ScratchFolder folder_;
  json report_;
  TraceRows rows_;
  std::vector<std::uint64_t> volumes_; // that were shown
};

TEST_F(Trace, a_volumes_stages_follow_each_other_from_its_last_line_to_the_glass) {
  ASSERT_EQ(volumes_.size(), report_["volumes"]["displayed"]);
  ASSERT_FALSE(volumes_.empty());
  std::vector<double> latencies_ms;
  for (const std::uint64_t volume : volumes_) {
    auto spans = passage(rows_, volume);
    EXPECT_EQ(gap_in(spans), "");
    latencies_ms.push_back((spans["flip"].end - spans["exposure"].end) * 1e-3);
  }
  const double longest = *std::ranges::max_element(latencies_ms);
  EXPECT_NEAR(longest, report_["latency_ms"]["max"].get<double>(), 0.002);
}

TEST_F(Trace, no_row_does_two_things_at_once_and_every_b_scan_is_there) {
  int b_scans = 0;
  for (const auto& [row, events] : rows_) {
    double free_from = -1e9;
    for (const auto& [begin, event] : events) {
      EXPECT_GE(begin, free_from - 0.002) << row << ": " << event;
      free_from = std::max(free_from, span_of(event).end);
      b_scans += row.starts_with("worker") ? 1 : 0;
    }
  }
  if (report_["lost"]["b_scans"] == 0) {
    EXPECT_EQ(b_scans, small_b_scans * static_cast<int>(volumes_.size()));
  }
}

TEST_F(Trace, the_report_counts_each_stage_of_each_volume_once) {
  const json& stages = report_.at("latency_stages");
  const std::size_t bins = stages.at("histogram_ms").size() + 1;
  for (const char* name :
       {"fetch", "queue", "reconstruct", "assemble", "wait", "upload", "draw", "flip"}) {
    const json& stage = stages.at(name);
    const std::vector<std::size_t> histogram = stage.at("histogram");
    EXPECT_EQ(histogram.size(), bins) << name;
    EXPECT_EQ(std::accumulate(histogram.begin(), histogram.end(), 0UL), volumes_.size()) << name;
    EXPECT_LE(stage.at("ms").at("max"), report_["latency_ms"]["max"]) << name;
  }
}

TEST_F(Trace, a_replay_has_no_stages) {
  const std::string recording = folder_ / "r.h5", report = folder_ / "replay.json";
  run_well({"record", "--sim", "--config", write_small_configuration(folder_), "--display",
            "offscreen", "--size", "64x36", "--volumes", "2", "--out", recording});
  run_well({"replay", recording, "--display", "offscreen", "--size", "64x36", "--once", "--report",
            report});
  EXPECT_FALSE(read_report(report).contains("latency_stages"));
}

} // namespace
} // namespace octascope::tests
