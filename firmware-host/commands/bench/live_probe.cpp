#include "firmware-host/commands/bench/live_probe.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "firmware-host/commands/bench/self_run.h"
#include "pipeline/scan/scan_plan.h"
#include "sim/spectra/tissue_motion.h"

namespace octascope::firmware_host {

namespace {

// The centre switch is held, so that the knob rotates the view, a detent for each refresh: fewer would ask for
// fewer frames than can be drawn.
void write_turning_knob(const std::filesystem::path& file, double seconds) {
  std::ofstream script{file};
  const auto event = [&](double time_s, const char* control, int value) {
    script << fmt::format("[[event]]\ntime_s = {:.3f}\n{}\nvalue = {}\n", time_s, control, value);
  };
  event(0.2, "switch = 1", 1);
  for (double time_s = 1; time_s < seconds; time_s += 1.0 / 60)
    event(time_s, "knob = 0", 1);
}

// What else it did, if the pedal's profile were another, would pass for turning and cost less.
hal::Result<> check_rotated(const nlohmann::json& report) {
  const double rotations = number_in(report, "/actions/rotate");
  if (rotations < 30)
    return hal::fail(
        hal::ErrorCode::invalid_argument,
        "the scripted knob rotated the view {} times, expected at least 30; leave the machine "
        "alone meanwhile, and see that the three-switch pedal's profile rotates with its centre "
        "switch held",
        rotations);
  return {};
}

} // namespace

hal::Result<LiveFigures> probe_live(int width, int height, double seconds) {
  HAL_TRY(const BenchFolder folder, BenchFolder::make());
  write_turning_knob(folder.file("knob.toml"), seconds);
  const auto run = [&](std::vector<std::string> more) {
    std::vector<std::string> arguments{"run",        "--sim",
                                       "--display",  "offscreen",
                                       "--size",     fmt::format("{}x{}", width, height),
                                       "--duration", fmt::format("{}", seconds)};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return report_of(std::move(arguments), folder.file("report.json"));
  };
  HAL_TRY(const auto turning, run({"--controls", folder.file("knob.toml").string()}));
  HAL_CHECK(check_rotated(turning));
  HAL_TRY(const auto resting, run({}));
  return LiveFigures{1000 * number_in(turning, "/first_picture_s"),
                     number_in(turning, "/rates/frames_per_s"),
                     quality_in(turning),
                     number_in(turning, "/control_ms/p50"),
                     number_in(turning, "/control_ms/p95"),
                     number_in(turning, "/latency_ms/p50"),
                     number_in(turning, "/latency_ms/p95"),
                     number_in(resting, "/latency_ms/p50"),
                     number_in(resting, "/latency_ms/p95"),
                     quality_in(resting),
                     number_in(turning, "/lost/volumes") + number_in(resting, "/lost/volumes")};
}

// A loop of one volume is made before the run begins, and nothing is computed besides.
hal::Result<LiveFlowFigures> probe_flow(int repeats) {
  const double line_rate_hz = repeats < pipeline::ScanPlan::most_repeats ? 215e3 : 860e3;
  HAL_TRY(const BenchFolder folder, BenchFolder::make());
  std::ofstream configuration{folder.file("flow.toml")};
  configuration << fmt::format("[scan]\nline_rate_hz = {}\nrepeats = {}\n[pipeline]\nflow = true\n"
                               "[sim]\nphantom = \"perfused\"\nloop_volumes = 1\n"
                               "axial_motion = [",
                               line_rate_hz, repeats);
  for (const sim::MotionTone& tone : bench_motion().axial)
    configuration << fmt::format("[{}, {}],", tone.amplitude_um, tone.frequency_hz);
  configuration << "]\n";
  configuration.close();
  HAL_TRY(const auto report,
          report_of({"run", "--sim", "--config", folder.file("flow.toml").string(), "--display",
                     "offscreen", "--size", "1280x720", "--duration", "10"},
                    folder.file("report.json")));
  const auto number = [&](const char* pointer) { return number_in(report, pointer); };
  const double planned = number("/volumes/planned") - number("/volumes/unfinished");
  const double told = number("/flow/b_scans/told");
  const double left_out = number("/flow/b_scans/left_out");
  const double b_scans = told + left_out + number("/flow/b_scans/none");
  const double planned_per_s = number("/scan/planned_volumes_per_s");
  return LiveFlowFigures{.line_rate_hz = line_rate_hz,
                         .planned_per_s = planned_per_s,
                         .angiograms_per_s =
                             number("/flow/angiograms") / std::max(planned, 1.0) * planned_per_s,
                         .compared_share = (told + left_out) / std::max(b_scans, 1.0),
                         .lost_lines = number("/lost/lines"),
                         .left_out_share = left_out / std::max(b_scans, 1.0),
                         .b_scan_ms_p50 = number("/flow/ms/p50"),
                         .b_scan_ms_p95 = number("/flow/ms/p95")};
}

} // namespace octascope::firmware_host
