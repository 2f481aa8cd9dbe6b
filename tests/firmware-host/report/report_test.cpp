#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "firmware-host/report/report.h"
#include "tests/support/fails_with.h"
#include "tests/support/files/scratch_folder.h"

namespace octascope::firmware_host {
namespace {

using namespace std::chrono_literals;
using nlohmann::json;

RunReport example() {
  RunReport r;
  r.simulated = true;
  r.source = "a \"quoted\" scene";
  r.reconstruction_path = "fused";
  r.reconstruction_isa = "AVX2";
  r.reconstruction_reason = "remembered";
  r.reconstruction_times = {{700.4, 1500.6}};
  r.line_camera = "sim";
  r.galvo_trigger = "gpio";
  r.control_input = "hid";
  r.scope_camera = "v4l2";
  r.display = "offscreen";
  r.plan.bidirectional = true;
  r.plan.repeats = 2;
  r.scan_lag = {.in_use_a_scans = 5.43219,
                .automatic = true,
                .used = 3,
                .refused = 1,
                .correlation = 0.5,
                .significance = 9};
  r.worker_cores = {2, -1};
  r.counters.volumes.acquired = 10;
  r.counters.volumes.published = 9;
  r.counters.displayed = 7;
  r.counters.volumes.skipped = 2;
  r.counters.undisplayed = 1;
  r.counters.volumes.planned = 16;
  r.counters.volumes.passed_over = 2;
  r.counters.volumes.unfinished = 3;
  r.counters.volumes.lost_lines = 600;
  r.counters.volumes.lost_b_scans = 2;
  r.counters.volumes.lost_volumes = 1;
  r.counters.volumes.saturated_lines = 5;
  r.duration_s = 1.5;
  r.counters.rates.lines_per_s = 215000.12345;
  r.counters.rates.volumes_per_s = 7.1;
  r.counters.rates.shown_volumes_per_s = 6.25;
  r.counters.rates.frames_per_s = 30;
  r.trees = {{.traced = 5, .refused = 2, .took = {.count = 7, .p50_ms = 612.3, .p95_ms = 801}}};
  r.quality = {.frames = 12, .resolution = {{0.7, 0.25}}, .steps = {{256, 80}}};
  r.counters.latency = {.count = 3, .p50_ms = 12.34567, .p95_ms = 20, .p99_ms = 20.5, .max_ms = 21};
  r.counters.frames_drawn = 45;
  r.counters.frames_missed = 3;
  r.counters.hot_path_allocations = 4;
  r.picture = {.freshness = {.liveness = ui::Liveness::stale, .age = 345678us},
               .notice = "Too much light: lines are saturated",
               .missing_b_scans = 2,
               .saturated_lines = 6,
               .another_camera = true};
  r.flow = FlowSummary{.angiograms = 8,
                       .told = 600,
                       .left_out = 20,
                       .none = 4,
                       .no_time = 3,
                       .tell = {700, 1, 1.25, 1.5, 2}};
  r.view.yaw_deg = -12.5F;
  r.view.technique = ui::Technique::shaded;
  r.view.layout = ui::LayoutKind::b_scan;
  r.view.stereo = ui::StereoMode::top_bottom;
  r.view.selected = ui::Action::tilt;
  r.actions[ui::index_of(ui::Action::freeze)] = 3;
  r.started = hal::TimePoint{100s};
  r.faults = {{fault_of(pipeline::Device::line_camera, hal::ErrorCode::disconnected),
               "it went away", 2, r.started + 1s, r.started + 2500ms}};
  return r;
}

TEST(Report, says_every_figure_under_its_key) {
  const json j = json::parse(to_json(example()));
  EXPECT_EQ(j["simulated"], true);
  EXPECT_EQ(j["reconstruction"]["path"], "fused");
  EXPECT_EQ(j["reconstruction"]["isa"], "AVX2");
  EXPECT_EQ(j["reconstruction"]["reason"], "remembered");
  EXPECT_EQ(j["reconstruction"]["fused_ns_per_line"], 700);
  EXPECT_EQ(j["reconstruction"]["fftw_ns_per_line"], 1501);
  EXPECT_EQ(j["source"], "a \"quoted\" scene");
  EXPECT_EQ(j["devices"], (json{{"line_camera", "sim"},
                                {"galvo_trigger", "gpio"},
                                {"control_input", "hid"},
                                {"scope_camera", "v4l2"},
                                {"display", "offscreen"}}));
  EXPECT_EQ(j["scan"], (json{{"bidirectional", true},
                             {"repeats", 2},
                             {"lines_per_sweep", 308},
                             {"kept_lines_per_sweep", 300},
                             {"sweeps_per_volume", 160},
                             {"planned_volumes_per_s", 4.354},
                             {"phase_offset",
                              {{"a_scans", 5.432},
                               {"automatic", true},
                               {"estimates_used", 3},
                               {"estimates_refused", 1},
                               {"correlation", 0.5},
                               {"significance", 9.0}}}}));
  EXPECT_EQ(j["workers"], (json{{"count", 2}, {"cores", {2, -1}}}));
  EXPECT_EQ(j["volumes"], (json{{"planned", 16},
                                {"acquired", 10},
                                {"published", 9},
                                {"displayed", 7},
                                {"skipped", 2},
                                {"passed_over", 2},
                                {"lost", 1},
                                {"unfinished", 3}}));
  const json& flow = j["flow"];
  EXPECT_EQ(flow["angiograms"], 8);
  EXPECT_NEAR(flow["angiograms_per_s"].get<double>(), 8 / j["duration_s"].get<double>(), 0.001);
  EXPECT_EQ(flow["b_scans"], (json{{"told", 600}, {"left_out", 20}, {"none", 4}, {"no_time", 3}}));
  EXPECT_EQ(flow["ms"], (json{{"p50", 1.0}, {"p95", 1.25}, {"p99", 1.5}, {"max", 2.0}}));
  EXPECT_EQ(j["lost"], (json{{"lines", 600}, {"b_scans", 2}, {"volumes", 1}}));
  EXPECT_EQ(j["rates"], (json{{"lines_per_s", 215000.123},
                              {"volumes_per_s", 7.1},
                              {"shown_volumes_per_s", 6.25},
                              {"frames_per_s", 30.0}}));
  EXPECT_EQ(j["quality"], (json{{"frames", 12},
                                {"resolution", {{"median", 0.7}, {"worst", 0.25}}},
                                {"steps", {{"median", 256.0}, {"worst", 80.0}}}}));
  EXPECT_EQ(j["latency_ms"], (json{{"p50", 12.346}, {"p95", 20.0}, {"p99", 20.5}, {"max", 21.0}}));
  EXPECT_EQ(j["frames"], (json{{"drawn", 45}, {"missed", 3}}));
  EXPECT_EQ(j["hot_path"], (json{{"allocations", 4}}));
  EXPECT_EQ(j["vessel_trees"], (json{{"traced", 5},
                                     {"refused", 2},
                                     {"seconds", {{"p50", 0.612}, {"p95", 0.801}, {"max", 0.0}}}}));
  EXPECT_EQ(j["picture"], (json{{"liveness", "stale"},
                                {"age_ms", 345.678},
                                {"notice", "Too much light: lines are saturated"},
                                {"missing_b_scans", 2},
                                {"saturated_lines", 6},
                                {"another_camera", true}}));
  EXPECT_EQ(j["view"], (json{{"window_offset_db", 8.0},
                             {"window_size_db", 36.0},
                             {"yaw_deg", -12.5},
                             {"tilt_deg", 35.0},
                             {"distance", 3.1},
                             {"b_scan", 40},
                             {"a_scan", 150},
                             {"zoom_to_tissue", true},
                             {"calliper", false},
                             {"mark_1_a", 100},
                             {"mark_1_depth", 170},
                             {"mark_2_a", 200},
                             {"mark_2_depth", 170},
                             {"parallax_deg", 3.0},
                             {"technique", "shaded"},
                             {"transfer", 0},
                             {"colours", 0},
                             {"opacity", 0.5},
                             {"see_through_db", 12.0},
                             {"cut", "off"},
                             {"layout", "b_scan"},
                             {"stereo", "top_bottom"},
                             {"frozen", false},
                             {"rolling", false},
                             {"vessels", "both"},
                             {"vessel_opacity", 1.0},
                             {"vessel_colours", "branch"},
                             {"vessel_shift_mm", {0.0, 0.0, 0.0}},
                             {"vessel_turn_deg", {0.0, 0.0, 0.0}},
                             {"box", true},
                             {"figures", "hidden"},
                             {"legend", false},
                             {"selected", "tilt"}}));
  EXPECT_EQ(j["actions"].size(), ui::action_count);
  EXPECT_EQ(j["actions"]["freeze"], 3);
  EXPECT_EQ(j["actions"]["tilt"], 0);
  for (const char* stage : {"reconstruct", "assemble", "publish", "upload", "draw"})
    EXPECT_EQ(j["stage_ms"][stage].size(), 4U) << stage;
}

TEST(Report, has_no_quality_of_a_volume_that_was_not_drawn) {
  RunReport r = example();
  r.quality = {};
  EXPECT_EQ(json::parse(to_json(r))["quality"],
            (json{{"frames", 0}, {"resolution", nullptr}, {"steps", nullptr}}));
  EXPECT_THAT(to_text(r), testing::Not(testing::HasSubstr("drawn at")));
}

TEST(Report, tells_a_faults_times_from_the_start) {
  const json faults = json::parse(to_json(example()))["faults"];
  EXPECT_EQ(faults, json::array({{{"device", "line_camera"},
                                  {"kind", "disconnected"},
                                  {"message", "it went away"},
                                  {"count", 2},
                                  {"first_s", 1.0},
                                  {"last_s", 2.5}}}));
}

TEST(Report, speaks_to_people_too) {
  const std::string text = to_text(example());
  EXPECT_THAT(text, testing::HasSubstr("7 volumes displayed of 12 that came"));
  EXPECT_THAT(text, testing::HasSubstr("\n2 volumes were not reconstructed: "));
  EXPECT_THAT(text, testing::HasSubstr("lost: 600 lines, 2 B-scans, 1 volumes"));
  EXPECT_THAT(text, testing::HasSubstr("trees: 5 traced, 2 refused; 0.61 s median, 0.80 s p95"));
  EXPECT_THAT(text, testing::HasSubstr("drawn at resolution 0.70 (worst 0.25), steps 256 (80)"));
  EXPECT_THAT(text, testing::HasSubstr("phase offset 5.43 A-scans, found in the picture"));
  EXPECT_THAT(text, testing::HasSubstr("fault: line_camera disconnected ×2: it went away"));
}

TEST(Report, is_written_whole_or_not_at_all) {
  const tests::ScratchFolder folder;
  ASSERT_TRUE(write_report(example(), folder / "r.json"));
  std::ifstream in{folder / "r.json"};
  EXPECT_EQ(json::parse(in), json::parse(to_json(example())));
  EXPECT_THAT(write_report(example(), folder / "nowhere/r.json"),
              tests::FailsSaying("nowhere/r.json"));
  EXPECT_EQ(folder.count(), 1);
}

} // namespace
} // namespace octascope::firmware_host
