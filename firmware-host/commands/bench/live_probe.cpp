#include "firmware-host/commands/bench/live_probe.h"

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "firmware-host/commands/bench/self_run.h"

namespace octascope::firmware_host {

namespace {

// The right switch twice: from the window's offset to the rotation. Then a detent each 50 ms.
void write_turning_knob(const std::filesystem::path& file, double seconds) {
  std::ofstream script{file};
  const auto event = [&](double time_s, const char* control, int value) {
    script << fmt::format("[[event]]\ntime_s = {:.3f}\n{}\nvalue = {}\n", time_s, control, value);
  };
  for (const double press_s : {0.2, 0.5}) {
    event(press_s, "switch = 2", 1);
    event(press_s + 0.1, "switch = 2", 0);
  }
  for (double time_s = 1; time_s < seconds; time_s += 0.05)
    event(time_s, "knob = 0", 1);
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

} // namespace octascope::firmware_host
