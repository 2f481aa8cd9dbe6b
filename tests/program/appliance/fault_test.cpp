// Every fault of every twin: the program goes on, the display shows it, the report counts it, and
// what returns is picked up. The scripts are short versions of the examples in sim/faults/examples.
#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <ostream>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sim/faults/fault_script.h"
#include "tests/program/program_support.h"
#include "tests/support/files/mutation.h"
#include "tests/support/program/built_places.h"

namespace octascope::tests {
namespace {

using nlohmann::json;
using ui::palette::frozen;
using ui::palette::warning;

// Which badge stands on the display while a fault is on.
enum class Badge { none, stale, missing_b_scans, saturated_lines, another_camera };

struct FaultCase {
  std::string example; // file in sim/faults
  std::string device;
  std::string kind;         // of the report
  std::string script;       // short: over before 1.2 s
  std::string lasting = {}; // the same, still on at the end; empty: no look at the display
  Badge badge = Badge::none;
  std::string_view notice = {}; // what the notice line says while it is on
  int fewest = 1;               // count in the report
  int lost_b_scans = 0;         // at least; no more than the report accounts for
  bool whole_volumes = false;   // loses volumes, at least one
  bool scanless_ticks = false;  // without camera or trigger: what is lost is in no fault's count
  std::string controls = {};    // what the pedal does meanwhile
  bool ends_frozen = false;     // …and so the picture is frozen at the end
  double duration_s = 2.1;
  friend void PrintTo(const FaultCase& c, std::ostream* out) { *out << c.example; }
};

std::string fault(std::string_view device, std::string_view kind, std::string_view more) {
  return fmt::format("[[fault]]\ndevice = \"{}\"\nkind = \"{}\"\n{}\n", device, kind, more);
}
std::string press(double at_s, int index, int value) {
  return fmt::format("[[event]]\ntime_s = {}\nswitch = {}\nvalue = {}\n", at_s, index, value);
}

constexpr double small_volume_period_ms = 200;

constexpr const char* half_a_second = "at_s = 0.6\nduration_s = 0.5";
constexpr const char* for_ever = "at_s = 0.6\nduration_s = 100.0";

std::vector<FaultCase> fault_cases() {
  const std::string camera = "line_camera";
  return {
      {.example = "line_camera_unplug",
       .device = camera,
       .kind = "disconnected",
       .script = fault(camera, "unplug", half_a_second),
       .lasting = fault(camera, "unplug", for_ever),
       .badge = Badge::stale,
       .notice = "Line camera disconnected: reconnecting",
       .whole_volumes = true,
       .scanless_ticks = true},
      {.example = "line_camera_exchanged",
       .device = camera,
       .kind = "another_camera",
       .script = fault(camera, "unplug", "at_s = 0.4\nduration_s = 0.3\ncomes_back_as = \"b\""),
       .lasting = fault(camera, "unplug", "at_s = 0.0\nduration_s = 0.1\ncomes_back_as = \"b\""),
       .badge = Badge::another_camera,
       .notice = "Depths unsure: change calibration",
       .scanless_ticks = true},
      {.example = "line_camera_dropped_frames",
       .device = camera,
       .kind = "dropped_frames",
       .script = fault(camera, "dropped_frames", "at_s = 0.6\ncount = 10"),
       .lasting = fault(camera, "dropped_frames", "at_s = 0.0\nduration_s = 100.0\nevery = 4"),
       .badge = Badge::missing_b_scans,
       .notice = "Line camera loses frames: B-scans are missing",
       .fewest = 10,
       .lost_b_scans = 10},
      {.example = "line_camera_corrupted_frames",
       .device = camera,
       .kind = "corrupted_frame",
       .script = fault(camera, "corrupted_frames", "at_s = 0.6\ncount = 8\nevery = 3"),
       .lasting = fault(camera, "corrupted_frames", "at_s = 0.0\nduration_s = 100.0\nevery = 4"),
       .badge = Badge::missing_b_scans,
       .notice = "Line camera sends broken frames: B-scans are missing",
       .fewest = 8,
       .lost_b_scans = 8},
      {.example = "line_camera_wrong_size",
       .device = camera,
       .kind = "wrong_size",
       .script = fault(camera, "wrong_size", "at_s = 0.5\ncount = 5\nsize_share = 0.5") +
                 fault(camera, "wrong_size", "at_s = 0.9\ncount = 4\nsize_share = 1.5"),
       .lasting = fault(camera, "wrong_size", "at_s = 0.0\nduration_s = 100.0\nevery = 4"),
       .badge = Badge::missing_b_scans,
       .notice = "Line camera sends frames of a wrong size: B-scans are missing",
       .fewest = 9,
       .lost_b_scans = 9},
      {.example = "line_camera_late_frames",
       .device = camera,
       .kind = "late_frame",
       // Through one whole sweep and a part of the next.
       .script = fault(camera, "late_frames", "at_s = 0.5\ncount = 30\nlate_ms = 150.0"),
       // Late enough that a machine that halts for 40 ms does not give them the time that they miss.
       .lasting = fault(camera, "late_frames", "at_s = 0.0\nduration_s = 100.0\nlate_ms = 180.0"),
       .badge = Badge::missing_b_scans,
       .notice = "Line camera is late: B-scans are missing"},
      {.example = "line_camera_stuck_sequence",
       .device = camera,
       .kind = "stuck_sequence",
       .script = fault(camera, "stuck_sequence", "at_s = 0.6\ncount = 20"),
       .fewest = 20},
      {.example = "line_camera_saturation",
       .device = camera,
       .kind = "saturation",
       .script = fault(camera, "saturation", "at_s = 0.5\nduration_s = 0.5\nline_share = 0.33"),
       .lasting = fault(camera, "saturation", "at_s = 0.0\nduration_s = 100.0\nline_share = 0.33"),
       .badge = Badge::saturated_lines,
       .notice = "Too much light: lines are saturated"},
      {.example = "galvo_trigger_missed_pulses",
       .device = "galvo_trigger",
       .kind = "missed_pulse",
       .script = fault("galvo_trigger", "missed_pulses", "at_s = 0.5\ncount = 2\nevery = 2"),
       .lasting = fault("galvo_trigger", "missed_pulses", for_ever),
       .badge = Badge::stale,
       .notice = "The scanner misses pulses: volumes are lost",
       .fewest = 2,
       .whole_volumes = true},
      {.example = "galvo_trigger_unplug",
       .device = "galvo_trigger",
       .kind = "disconnected",
       .script = fault("galvo_trigger", "unplug", half_a_second),
       .lasting = fault("galvo_trigger", "unplug", for_ever),
       .badge = Badge::stale,
       .notice = "Scanner trigger disconnected: reconnecting",
       .whole_volumes = true,
       .scanless_ticks = true},
      {.example = "control_input_unplug",
       .device = "control_input",
       .kind = "disconnected",
       .script = fault("control_input", "unplug", half_a_second),
       .lasting = fault("control_input", "unplug", for_ever),
       .notice = "Pedal disconnected: reconnecting",
       .controls = press(1.6, 1, 1) + press(1.7, 1, 0),
       .ends_frozen = true},
      {.example = "control_input_bounce",
       .device = "control_input",
       .kind = "bounce",
       .script = fault("control_input", "bounce",
                       "at_s = 0.0\nduration_s = 100.0\nbounces = 6\nbounce_ms = 4.0"),
       .fewest = 12, // six at the press, six at the release
       .controls = press(0.8, 1, 1) + press(1.0, 1, 0),
       .ends_frozen = true}, // by one press, not by seven
      {.example = "control_input_stuck_switch",
       .device = "control_input",
       .kind = "stuck_switch",
       .script = fault("control_input", "stuck_switch",
                       "at_s = 0.3\nduration_s = 4.4\nswitch = 0\npressed = true"),
       .lasting = fault("control_input", "stuck_switch",
                        "at_s = 0.0\nduration_s = 100.0\nswitch = 0\npressed = true"),
       .notice = "A pedal switch stays down: is it stuck?",
       .controls = press(5.1, 1, 1) + press(5.2, 1, 0),
       .ends_frozen = true,
       .duration_s = 5.7},
      {.example = "scope_camera_unplug",
       .device = "scope_camera",
       .kind = "disconnected",
       .script = fault("scope_camera", "unplug", half_a_second),
       .lasting = fault("scope_camera", "unplug", for_ever),
       .notice = "Microscope camera disconnected: reconnecting"},
      {.example = "display_lost",
       .device = "display",
       .kind = "disconnected",
       // Long enough for a turn of the render loop on a machine that is held up by others.
       .script = fault("display", "lost", "at_s = 0.6\nduration_s = 1.5"),
       .duration_s = 5.0},
  };
}

class Faults : public testing::TestWithParam<FaultCase> {
protected:
  ProgramResult run(const std::string& script, double duration_s) {
    std::vector<std::string> more{"--faults",   folder_.write("faults.toml", script),
                                  "--duration", fmt::format("{}", duration_s),
                                  "--snapshot", snapshot_,
                                  "--report",   report_};
    if (!GetParam().controls.empty())
      more.insert(more.end(), {"--controls", folder_.write("controls.toml", GetParam().controls)});
    return run_octascope(small_run(folder_, more));
  }

  ScratchFolder folder_;
  std::string snapshot_ = folder_ / "picture.png";
  std::string report_ = folder_ / "report.json";
};

int count_of(const json& report, std::string_view device, std::string_view kind) {
  const json fault = find_fault(report, device, kind);
  return fault.is_null() ? 0 : fault["count"].get<int>();
}

// Volumes of which the report says why nothing came, be it the script or a machine that was busy.
int accounted_volumes(const json& report) {
  return count_of(report, "pipeline", "late_tick") + count_of(report, "pipeline", "overrun") +
         count_of(report, "galvo_trigger", "missed_pulse");
}

// Likewise frames that came broken, late, or not at all.
int accounted_frames(const json& report) {
  int frames = 0;
  for (const char* kind : {"dropped_frames", "corrupted_frame", "wrong_size", "late_frame",
                           "unplaced_frame", "overflow"})
    frames += count_of(report, "line_camera", kind);
  return frames;
}

// No less is lost than the script takes, and no more than there are faults to account for: where
// the machine takes nothing, these are the same.
void expect_losses(const json& report, const FaultCase& c) {
  const int lines = report["lost"]["lines"];
  const int b_scans = report["lost"]["b_scans"];
  const int volumes = report["lost"]["volumes"];
  EXPECT_EQ(lines, b_scans * small_a_scans) << "the kept lines of the lost B-scans";
  EXPECT_GE(b_scans, volumes * small_b_scans) << "those of lost volumes among them";
  EXPECT_GE(volumes, c.whole_volumes ? 1 : 0);
  EXPECT_GE(volumes, count_of(report, "galvo_trigger", "missed_pulse"));
  EXPECT_GE(b_scans, c.lost_b_scans);
  EXPECT_GE(b_scans, count_of(report, "line_camera", "late_frame"));
  if (!c.scanless_ticks) {
    EXPECT_LE(volumes, accounted_volumes(report)) << report["faults"].dump(2);
    EXPECT_LE(b_scans, accounted_volumes(report) * small_b_scans + accounted_frames(report))
        << report["faults"].dump(2);
  }
  EXPECT_EQ(report["saturated_lines"], count_of(report, "line_camera", "saturation"));
  for (const auto& [device, kind] : {std::pair{"line_camera", "stuck_sequence"},
                                     {"line_camera", "saturation"},
                                     {"control_input", "bounce"}}) {
    if (c.kind != kind) {
      EXPECT_EQ(count_of(report, device, kind), 0) << kind << ": no machine makes these";
    } else if (c.kind != "saturation") {
      EXPECT_LE(count_of(report, device, kind), c.fewest) << "as many as the script says";
    }
  }
}

TEST_P(Faults, are_survived_counted_and_over_when_they_are_over) {
  const FaultCase& c = GetParam();
  const ProgramResult result = run(c.script, c.duration_s);
  ASSERT_EQ(result.exit_status, 0) << result.describe();
  const json report = read_report(report_);
  const json fault = find_fault(report, c.device, c.kind);
  ASSERT_FALSE(fault.is_null()) << report["faults"].dump(2);
  // A frame that the machine lost was not there to be broken.
  const int lost_by_machine =
      c.kind == "dropped_frames" ? 0 : count_of(report, "line_camera", "dropped_frames");
  EXPECT_GE(fault["count"].get<int>() + lost_by_machine, c.fewest);
  EXPECT_NE(fault["message"], "");
  EXPECT_GE(fault["first_s"], 0);
  EXPECT_LE(fault["first_s"], fault["last_s"]);
  EXPECT_THAT(result.out, testing::HasSubstr("fault: " + c.device + " " + c.kind));
  expect_losses(report, c);

  // Of the volumes that fit into the run (five a second), more were shown than fit in before the
  // fault began.
  EXPECT_GE(report["volumes"]["published"], 4);
  EXPECT_GE(report["volumes"]["displayed"], c.ends_frozen ? 1 : 4);
  const pipeline::Image picture = read_snapshot(snapshot_);
  ASSERT_EQ(picture.width, small_width);
  EXPECT_EQ(count_colour(picture, badge_row(picture), frozen) > 0, c.ends_frozen);
}

bool has_badge(const json& report, Badge badge) {
  const json& picture = report["picture"];
  switch (badge) {
  case Badge::none: return true;
  case Badge::stale: return picture["liveness"] == "stale";
  case Badge::missing_b_scans: return picture["missing_b_scans"] > 0;
  case Badge::saturated_lines: return picture["saturated_lines"] > 0;
  case Badge::another_camera: return picture["another_camera"];
  }
  return false;
}

// The picture bears the marks that the report tells of, and no other.
void expect_told_marks(const pipeline::Image& picture, const json& report) {
  const auto expect = [&](const ui::Rect& where, int at_least, bool told) {
    const int pixels = count_colour(picture, where, warning);
    EXPECT_GE(pixels, told ? at_least : 0) << report["picture"].dump(2);
    EXPECT_LE(pixels, told ? where.width * where.height : 0) << report["picture"].dump(2);
  };
  expect(badge_row(picture), 4,
         std::ranges::any_of(std::array{Badge::stale, Badge::missing_b_scans,
                                        Badge::saturated_lines, Badge::another_camera},
                             [&](Badge badge) { return has_badge(report, badge); }));
  expect(notice_row(picture), 11, report["picture"]["notice"] != "");
}

// What a machine that is held up by others may be told of, if it is in the report.
bool is_of_a_busy_machine(const json& report, const std::string& notice) {
  struct Excuse {
    std::string_view device, kind, notice;
  };
  constexpr std::array excuses{
      Excuse{"pipeline", "overrun", "Reconstruction is too slow: volumes are lost"},
      Excuse{"pipeline", "late_tick", "The computer is busy: volumes are lost"},
      Excuse{"galvo_trigger", "missed_pulse", "The scanner misses pulses: volumes are lost"},
      Excuse{"line_camera", "dropped_frames", "Line camera loses frames: B-scans are missing"},
      Excuse{"line_camera", "late_frame", "Line camera is late: B-scans are missing"}};
  return std::ranges::any_of(excuses, [&](const Excuse& excuse) {
    return notice == excuse.notice && count_of(report, excuse.device, excuse.kind) > 0;
  });
}

class ShownFaults : public Faults {};

TEST_P(ShownFaults, are_on_the_display_while_they_are_on) {
  const FaultCase& c = GetParam();
  // A switch that is down is told after four seconds, and shown for two.
  const double until_noticed_s = c.kind == "stuck_switch" ? 5.0 : sanitized ? 2.8 : 1.4;
  const ProgramResult result = run(c.lasting, until_noticed_s);
  ASSERT_EQ(result.exit_status, 0) << result.describe();
  const json report = read_report(report_);
  expect_told_marks(read_snapshot(snapshot_), report);
  EXPECT_TRUE(has_badge(report, c.badge)) << report.dump(2);
  const std::string notice = report["picture"]["notice"];
  if (!is_of_a_busy_machine(report, notice)) {
    EXPECT_EQ(notice, c.notice) << report["faults"].dump(2);
  }
}

std::vector<FaultCase> shown_fault_cases() {
  std::vector<FaultCase> cases = fault_cases();
  std::erase_if(cases, [](const FaultCase& c) { return c.lasting.empty(); });
  return cases;
}

INSTANTIATE_TEST_SUITE_P(Scripts, Faults, testing::ValuesIn(fault_cases()),
                         [](const auto& test) { return test.param.example; });
INSTANTIATE_TEST_SUITE_P(Scripts, ShownFaults, testing::ValuesIn(shown_fault_cases()),
                         [](const auto& test) { return test.param.example; });

// A machine that is held up by others may earn a mark: then the report has the reason.
TEST(NoFault, has_no_marks) {
  const ScratchFolder folder;
  const std::string snapshot = folder / "picture.png";
  const std::string report_file = folder / "report.json";
  run_well(
      small_run(folder, {"--duration", "1.2", "--snapshot", snapshot, "--report", report_file}));
  const pipeline::Image picture = read_snapshot(snapshot);
  const json report = read_report(report_file);
  EXPECT_GT(count_colour(picture, badge_row(picture), ui::palette::simulated), 0);
  expect_told_marks(picture, report);
  const json& told = report["picture"];
  const std::string notice = told["notice"];
  EXPECT_TRUE(notice.empty() || is_of_a_busy_machine(report, notice)) << report.dump(2);
  EXPECT_LE(told["missing_b_scans"], accounted_frames(report)) << report.dump(2);
  EXPECT_EQ(told["saturated_lines"], 0);
  EXPECT_EQ(told["another_camera"], false);
  EXPECT_TRUE(told["liveness"] == "live" || report["volumes"]["displayed"] == 0 ||
              told["age_ms"] > 1.5 * small_volume_period_ms)
      << report.dump(2);
}

TEST(DisplayLost, at_the_end_costs_the_picture_and_not_the_report) {
  const ScratchFolder folder;
  const std::string report = folder / "report.json";
  const ProgramResult result = run_octascope(small_run(
      folder, {"--faults", folder.write("faults.toml", fault("display", "lost", for_ever)),
               "--duration", "1.2", "--snapshot", folder / "picture.png", "--report", report}));
  EXPECT_EQ(result.exit_status, 1) << result.describe();
  EXPECT_THAT(result.err, testing::HasSubstr("picture.png"));
  EXPECT_FALSE(std::filesystem::exists(folder / "picture.png"));
  EXPECT_FALSE(find_fault(read_report(report), "display", "disconnected").is_null());
  EXPECT_GE(read_report(report)["volumes"]["published"], 3) << "acquisition goes on";
}

// A script whose times are a third of the file's.
std::string three_times_as_fast(const std::filesystem::path& file) {
  std::string script = whole_file(file);
  for (std::size_t at = 0; (at = script.find("_s = ", at)) != std::string::npos;) {
    at += 5;
    std::size_t digits = 0;
    const double time_s = std::stod(script.substr(at), &digits);
    script.replace(at, digits, fmt::format("{:.3f}", time_s / 3));
  }
  return script;
}

// The worst of days, as it is shipped but faster.
TEST(Everything, at_once_is_survived) {
  const ScratchFolder folder;
  const std::string report_file = folder / "report.json";
  const auto script = folder.write(
      "faults.toml", three_times_as_fast(source_folder() / "sim/faults/examples/everything.toml"));
  run_well(small_run(folder, {"--faults", script, "--duration", "6", "--report", report_file}));
  const json report = read_report(report_file);
  for (const auto& [device, kind] : {std::pair{"line_camera", "disconnected"},
                                     {"line_camera", "dropped_frames"},
                                     {"line_camera", "corrupted_frame"},
                                     {"galvo_trigger", "disconnected"},
                                     {"control_input", "disconnected"},
                                     {"scope_camera", "disconnected"},
                                     {"display", "disconnected"}})
    EXPECT_FALSE(find_fault(report, device, kind).is_null()) << device << " " << kind;
  EXPECT_GE(report["volumes"]["published"], 8);
}

// No example, and no kind of fault, is without a test.
TEST(Everything, shipped_has_a_test) {
  std::set<std::string> tested{"everything"};
  std::set<pipeline::Fault> kinds;
  for (const FaultCase& c : fault_cases()) {
    tested.insert(c.example);
    const auto script = sim::FaultScript::parse(c.script, c.example);
    ASSERT_TRUE(script) << script.error().message;
    for (const sim::ScriptedFault& f : script->faults)
      kinds.insert(f.kind);
  }
  for (const sim::ScriptableFault& scriptable : sim::scriptable_faults())
    EXPECT_TRUE(kinds.contains(scriptable.fault))
        << facts_of(scriptable.fault).device_key() << " " << scriptable.kind;
  std::set<std::string> shipped;
  for (const auto& entry :
       std::filesystem::directory_iterator{source_folder() / "sim/faults/examples"})
    shipped.insert(entry.path().stem());
  EXPECT_EQ(shipped, tested);
}

} // namespace
} // namespace octascope::tests
