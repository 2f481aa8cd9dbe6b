// octascope replay: a recording on the display.
#include <cstdio>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "firmware-host/commands/arguments.h"
#include "firmware-host/commands/command.h"
#include "firmware-host/replay.h"
#include "firmware-host/run_options.h"
#include "firmware-host/stop_signal.h"
#include "pipeline/recordings/replay_schedule.h"

namespace octascope::firmware_host {

namespace {

// As text, the way CLI11 collects it.
struct ReplayArguments {
  std::string file, configuration, display = "auto", size, snapshot, report, vessels, registration;
  double rate = 1;
  bool once = false;
  std::size_t from = 0;
  double duration_s = 0;
  std::uint64_t volumes = 0;
};

std::optional<std::filesystem::path> path_if_said(const std::string& text) {
  return text.empty() ? std::nullopt : std::optional<std::filesystem::path>{text};
}

DisplayChoice display_named(const std::string& name) {
  return name == "kms"         ? DisplayChoice::kms
         : name == "window"    ? DisplayChoice::window
         : name == "offscreen" ? DisplayChoice::offscreen
                               : DisplayChoice::automatic;
}

hal::Result<RunOptions> options_of(const ReplayArguments& a) {
  RunOptions o;
  o.replay = ReplayOptions{.file = a.file, .rate = a.rate, .once = a.once, .from = a.from};
  o.configuration = path_if_said(a.configuration);
  o.snapshot = path_if_said(a.snapshot);
  o.report = path_if_said(a.report);
  o.vessels = path_if_said(a.vessels);
  o.registration = path_if_said(a.registration);
  o.display = display_named(a.display);
  if (a.duration_s > 0)
    o.duration_s = a.duration_s;
  if (a.volumes > 0)
    o.volumes = a.volumes;
  if (a.size.empty())
    return o;
  return parse_size(a.size).map([&](const std::array<int, 2>& size) {
    o.size = size;
    return o;
  });
}

int complain(const hal::Error& error) {
  fmt::print(stderr, "octascope replay: {}\n", error.message);
  return error.fault == hal::Fault::invalid_argument ? exit_wrong_use : exit_failed;
}

int replay(const ReplayArguments& arguments) {
  const auto options = options_of(arguments);
  if (!options)
    return complain(options.error());
  StopSignal stop_signal; // before the first thread
  auto assembled = Replay::assemble(*options);
  if (!assembled)
    return complain(assembled.error());
  if (const auto ran = (*assembled)->run(stop_signal); !ran)
    return complain(ran.error());
  return exit_done;
}

void add_picture_options(CLI::App& command, ReplayArguments& a) {
  command.add_option("--config", a.configuration, "Configuration (TOML): display, look, controls");
  command.add_option("--display", a.display, "Where the picture goes")
      ->check(CLI::IsMember({"auto", "kms", "window", "offscreen"}))
      ->capture_default_str();
  command.add_option("--size", a.size, "Size of the picture in pixels, as 1280x720");
  CLI::Option* vessels =
      command
          .add_option("--vessels", a.vessels,
                      "Vessel tree to show in the volume: ours, SWC (in µm) or VTP (in mm)")
          ->type_name("FILE");
  command
      .add_option("--registration", a.registration,
                  "Where it lies in the volume; else in its middle, marked as not registered")
      ->type_name("FILE.toml")
      ->needs(vessels);
}

void add_time_options(CLI::App& command, ReplayArguments& a) {
  command
      .add_option("--rate", a.rate,
                  "How fast: 2 is twice as fast as it was recorded (1 if not given)")
      ->check(CLI::Range(pipeline::slowest_replay, pipeline::fastest_replay));
  command.add_flag("--once", a.once, "End after the last volume, and do not begin anew");
  command.add_option("--from", a.from, "The first volume to show, counted from 0 (0 if not given)");
  auto* duration = command.add_option("--duration", a.duration_s, "End after so many seconds")
                       ->check(CLI::Range(0.1, 1e9));
  command.add_option("--volumes", a.volumes, "End after so many volumes")
      ->check(CLI::Range(1, 1000000000))
      ->excludes(duration);
}

} // namespace

void add_replay_command(CLI::App& program, int& exit_status) {
  auto arguments = std::make_shared<ReplayArguments>();
  ReplayArguments& a = *arguments;
  CLI::App* command = program.add_subcommand(
      "replay", "Show a recording, marked as such, at the times it was made");
  command->add_option("file", a.file, "Recording (HDF5)")->required()->type_name("FILE.h5");
  add_picture_options(*command, a);
  add_time_options(*command, a);
  command->add_option("--snapshot", a.snapshot, "Write the last picture here (PNG)");
  command->add_option("--report", a.report, "Write the report here (JSON)");
  command->footer("Examples:\n"
                  "  octascope replay eye.h5\n"
                  "  octascope replay eye.h5 --from 120 --rate 0.5 --once\n"
                  "  octascope replay eye.h5 --display offscreen --volumes 10 --snapshot eye.png\n"
                  "The screen says REPLAY, with date and time of the shown volume. Keys and pedal "
                  "do what they do in octascope run; what is frozen is held, and goes on from "
                  "there.");
  command->callback([arguments, &exit_status] { exit_status = replay(*arguments); });
}

} // namespace octascope::firmware_host
