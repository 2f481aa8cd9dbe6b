// octascope replay: a recording on the display.
#include <memory>
#include <string>

#include <CLI/CLI.hpp>

#include "firmware-host/commands/arguments.h"
#include "firmware-host/commands/command.h"
#include "firmware-host/commands/numbers.h"
#include "firmware-host/configuration/run_options.h"
#include "firmware-host/run/appliance.h"
#include "firmware-host/run/stop_signal.h"
#include "pipeline/recordings/replay/replay_schedule.h"

namespace octascope::firmware_host {

namespace {

struct ReplayArguments {
  std::string file;
  double rate = 1;
  bool once = false;
  std::size_t from = 0;
  ShowArguments show;
};

hal::Result<RunOptions> options_of(const ReplayArguments& a) {
  RunOptions o;
  o.replay = ReplayOptions{.file = a.file, .rate = a.rate, .once = a.once, .from = a.from};
  return read_show_options(a.show, o).map([&] { return o; });
}

int replay(const ReplayArguments& arguments) {
  const auto options = options_of(arguments);
  if (!options)
    return complain("replay", options.error());
  StopSignal stop_signal; // before the first thread
  auto assembled = Appliance::assemble(*options, nullptr);
  if (!assembled)
    return complain("replay", assembled.error());
  if (const auto ran = (*assembled)->run(stop_signal); !ran)
    return complain("replay", ran.error());
  return exit_done;
}

void add_time_options(CLI::App& command, ReplayArguments& a) {
  command
      .add_option("--rate", a.rate,
                  "How fast: 2 is twice as fast as it was recorded (1 if not given)")
      ->check(within(pipeline::slowest_replay, pipeline::fastest_replay));
  command.add_flag("--once", a.once, "End after the last volume, and do not begin anew");
  command.add_option("--from", a.from, "The first volume to show, counted from 0 (0 if not given)")
      ->check(within(0, 1000000000));
}

} // namespace

void add_replay_command(CLI::App& program, int& exit_status) {
  auto arguments = std::make_shared<ReplayArguments>();
  ReplayArguments& a = *arguments;
  CLI::App* command = program.add_subcommand(
      "replay", "Show a recording, marked as such, at the times it was made");
  command->add_option("file", a.file, "Recording (HDF5)")->required()->type_name("FILE.h5");
  add_time_options(*command, a);
  add_show_options(*command, a.show);
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
