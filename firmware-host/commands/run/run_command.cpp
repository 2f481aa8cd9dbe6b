// octascope run: the appliance. octascope record: the same, with its volumes kept from the first
// on.
#include <cstdio>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "firmware-host/commands/arguments.h"
#include "firmware-host/commands/command.h"
#include "firmware-host/commands/numbers.h"
#include "firmware-host/commands/spectra_type.h"
#include "firmware-host/configuration/run_options.h"
#include "firmware-host/crash/crash_report.h"
#include "firmware-host/run/appliance.h"
#include "firmware-host/run/stop_signal.h"
#include "firmware-host/supervision/service_manager.h"
#include "firmware-host/terminal/terminal.h"
#include "pipeline/scan/scan_plan.h"
#include "ui/controls/legend_lines.h"

namespace octascope::firmware_host {

namespace {

// As text, the way CLI11 collects it.
struct RunArguments {
  std::string spectra, shape, calibration, faults, controls, phantom, record_to, raw_to, subject,
      eye, trace, flow;
  SpectraTypeArguments type;
  bool simulate = false;
  bool bidirectional = false;
  bool rolling = false;
  int repeats = 0;
  ShowArguments show;
};

// A line a key, or a few for the same action.
std::string key_help() {
  std::string lines;
  const auto add = [&](std::string_view keys, std::string_view meaning) {
    lines += fmt::format("  {:<36}{}\n", keys, meaning);
  };
  for (const ui::LegendLine& line : ui::make_key_legend().lines)
    add(line.control, label_of(line.action));
  add("1  2  3", "Switches of the simulated pedal");
  add(",  .", "Simulated knob, left and right");
  add("Q  escape", "End the program");
  lines.pop_back();
  return lines;
}

hal::Result<RunOptions> options_of(const RunArguments& a) {
  RunOptions o;
  HAL_CHECK(read_show_options(a.show, o));
  o.calibration = path_of(a.calibration);
  o.faults = path_of(a.faults);
  o.controls = path_of(a.controls);
  o.trace = path_of(a.trace);
  o.simulate = a.simulate;
  if (!a.phantom.empty())
    o.phantom = a.phantom;
  o.bidirectional = a.bidirectional;
  o.rolling = a.rolling;
  o.record_to = path_of(a.record_to);
  o.raw_to = path_of(a.raw_to);
  if (o.record_to && o.raw_to && o.record_to->lexically_normal() == o.raw_to->lexically_normal())
    return hal::fail(hal::ErrorCode::invalid_argument,
                     "--out and --raw are both {}, expected two files", a.raw_to);
  o.subject = a.subject;
  o.eye = pipeline::eye_named(a.eye).value_or(pipeline::Eye::not_said);
  if (a.repeats > 0)
    o.repeats = a.repeats;
  if (!a.flow.empty())
    o.flow = a.flow == "on";
  if (!a.spectra.empty()) {
    HAL_TRY(const auto recording, recording_options(a.spectra, a.shape, a.type));
    o.recording = recording;
  } else if (!a.shape.empty()) {
    return hal::fail(hal::ErrorCode::invalid_argument, "--shape needs --spectra FILE");
  }
  return o;
}

int run(const char* command, const RunArguments& arguments) {
  const auto options = options_of(arguments);
  if (!options)
    return complain(command, options.error());
  const auto state = service_folders().state;
  StopSignal stop_signal{state ? HangUp::reloads : HangUp::ends}; // before the first thread
  CrashReport crash_report;
  if (state)
    if (const auto kept = crash_report.keep_in(crash_folder(*state)); !kept)
      warn("octascope {}: {}\n", command, kept.error().message);
  auto appliance = Appliance::assemble(*options, &crash_report);
  if (!appliance)
    return complain(command, appliance.error());
  if (const auto ran = (*appliance)->run(stop_signal); !ran)
    return complain(command, ran.error());
  return exit_done;
}

void add_options(CLI::App& command, RunArguments& a) {
  add_show_options(command, a.show);
  command
      .add_option("--trace", a.trace,
                  "Write here what each thread did for the last 1000 volumes that were shown; "
                  "open it with ui.perfetto.dev or chrome://tracing")
      ->type_name("FILE.json");
  command.add_flag("--sim", a.simulate, "Use the simulated devices, whatever is plugged in");
  CLI::Option* spectra =
      command
          .add_option("--spectra", a.spectra,
                      "Play raw spectra (little-endian, [B][A][N], or a recording of them, HDF5) "
                      "instead of a phantom")
          ->type_name("FILE");
  command.add_option("--shape", a.shape, "B-scans,A-scans,samples of --spectra, as 100,100,1024")
      ->type_name("B,A,N");
  add_spectra_type_options(command, a.type, spectra);
  command.add_option("--calibration", a.calibration, "Calibration of the spectrometer")
      ->type_name("FILE.toml");
  command.add_option("--phantom", a.phantom, "What the simulated camera sees");
  command.add_flag("--bidirectional", a.bidirectional,
                   "Scan there and back, without fly-back, whatever the configuration says");
  command.add_flag("--rolling", a.rolling,
                   "Show each B-scan as it comes, over those of the volume before, with a seam "
                   "between the two; else whole volumes");
  command.add_option("--repeats", a.repeats, "Sweeps of each B-scan, averaged (1 to 4)")
      ->check(within(1, pipeline::ScanPlan::most_repeats));
  command
      .add_option("--flow", a.flow,
                  "Compare the repeats of each B-scan, say what flows, and show it as a tree of "
                  "vessels (without --vessels); needs 2 or more, in one direction")
      ->check(CLI::IsMember({"on", "off"}));
  command.add_option("--faults", a.faults, "Faults that the simulated devices suffer")
      ->type_name("FILE.toml");
  command.add_option("--controls", a.controls, "What the simulated pedal and knob do")
      ->type_name("FILE.toml");
  command.add_option("--subject", a.subject,
                     "Whose recordings these are, as they shall say it; not kept for later runs");
  command.add_option("--eye", a.eye, "Of which eye they are")
      ->check(CLI::IsMember({"left", "right"}));
}

} // namespace

void add_run_command(CLI::App& program, int& exit_status) {
  auto arguments = std::make_shared<RunArguments>();
  CLI::App* command =
      program.add_subcommand("run", "Run the appliance: acquire, reconstruct, show");
  command->footer("Examples:\n"
                  "  octascope run --sim --duration 20\n"
                  "  octascope run --sim --phantom perfused --repeats 2 --flow on\n"
                  "  octascope run --spectra s.raw --shape 100,100,1024 --calibration c.toml "
                  "--display offscreen --volumes 5 --snapshot t.png --report t.json\n"
                  "Keys in a window:\n" +
                  key_help());
  add_options(*command, *arguments);
  command->callback([arguments, &exit_status] { exit_status = run("run", *arguments); });
}

void add_record_command(CLI::App& program, int& exit_status) {
  auto arguments = std::make_shared<RunArguments>();
  CLI::App* command = program.add_subcommand(
      "record", "Run the appliance and keep its volumes, or raw spectra (HDF5)");
  command->footer("Example:\n"
                  "  octascope record --out eye.h5 --sim --duration 20 --eye left\n"
                  "  octascope record --out eye.h5 --raw eye-raw.h5 --duration 20\n"
                  "Status 1 where a file holds nothing, is gone, or the recording ended before "
                  "the run.\n"
                  "In a run that is under way, r or the pedal's recording begins and ends one.\n"
                  "octascope info, export and replay take it from there.");
  command->add_option("--out", arguments->record_to, "The recording: a file that is not there yet")
      ->type_name("FILE.h5");
  command
      ->add_option("--raw", arguments->raw_to,
                   "The raw spectra, beside --out or instead: likewise (440 MB/s at 215 kHz)")
      ->type_name("FILE.h5");
  add_options(*command, *arguments);
  command->callback([arguments, &exit_status] {
    exit_status = arguments->record_to.empty() && arguments->raw_to.empty()
                      ? complain("record", {hal::ErrorCode::invalid_argument,
                                            "expected --out FILE.h5, --raw FILE.h5 or both"})
                      : run("record", *arguments);
  });
}

} // namespace octascope::firmware_host
