// octascope capture: raw spectra to a file.
#include <limits>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>

#include "firmware-host/capture/capture.h"
#include "firmware-host/commands/arguments.h"
#include "firmware-host/commands/command.h"
#include "firmware-host/commands/numbers.h"
#include "firmware-host/commands/spectra_type.h"
#include "firmware-host/run/stop_signal.h"

namespace octascope::firmware_host {

namespace {

struct CaptureArguments {
  std::string file, configuration, calibration, spectra, shape, phantom, subject, eye;
  SpectraTypeArguments type;
  std::uint64_t lines = 0;
  std::uint64_t volumes = 0;
  bool average = false;
  bool simulate = false;
};

hal::Result<CaptureOptions> options_of(const CaptureArguments& a) {
  CaptureOptions options;
  options.file = a.file;
  if (a.lines > 0)
    options.lines = a.lines;
  if (a.volumes > 0)
    options.volumes = a.volumes;
  options.average = a.average;
  RunOptions& run = options.run;
  run.display = DisplayChoice::offscreen; // made, never opened
  run.configuration = path_of(a.configuration);
  run.calibration = path_of(a.calibration);
  run.simulate = a.simulate;
  if (!a.phantom.empty())
    run.phantom = a.phantom;
  run.subject = a.subject;
  run.eye = pipeline::eye_named(a.eye).value_or(pipeline::Eye::not_said);
  if (!a.spectra.empty()) {
    HAL_TRY(run.recording, recording_options(a.spectra, a.shape, a.type));
  }
  return options;
}

int run(const CaptureArguments& arguments) {
  const auto options = options_of(arguments);
  if (!options)
    return complain("capture", options.error());
  StopSignal stop_signal; // before the first thread
  if (const auto captured = capture(*options, stop_signal); !captured)
    return complain("capture", captured.error());
  return exit_done;
}

void add_source_options(CLI::App& command, CaptureArguments& a) {
  command.add_option("--config", a.configuration, "Configuration (TOML)")->type_name("FILE.toml");
  command.add_flag("--sim", a.simulate, "Use the simulated devices, whatever is plugged in");
  command.add_option("--phantom", a.phantom, "What the simulated camera sees");
  CLI::Option* spectra = command
                             .add_option("--spectra", a.spectra,
                                         "Play raw spectra instead of a phantom: little-endian, "
                                         "[B][A][N], or a recording of them")
                             ->type_name("FILE");
  command.add_option("--shape", a.shape, "B-scans,A-scans,samples of --spectra, as 100,100,1024")
      ->needs(spectra)
      ->type_name("B,A,N");
  add_spectra_type_options(command, a.type, spectra);
  command
      .add_option("--calibration", a.calibration,
                  "Calibration to keep with them, if there is one already")
      ->type_name("FILE.toml");
  command.add_option("--subject", a.subject, "Whose they are, as the file shall say it");
  command.add_option("--eye", a.eye, "Of which eye they are")
      ->check(CLI::IsMember({"left", "right"}));
}

} // namespace

void add_capture_command(CLI::App& program, int& exit_status) {
  auto arguments = std::make_shared<CaptureArguments>();
  CaptureArguments& a = *arguments;
  CLI::App* command =
      program.add_subcommand("capture", "Raw spectra of the line camera to a file (HDF5)");
  command->add_option("--out", a.file, "A file that is not there yet")
      ->required()
      ->type_name("FILE.h5");
  const auto most = static_cast<std::uint64_t>(std::numeric_limits<int>::max());
  CLI::Option* lines =
      command
          ->add_option("--lines", a.lines,
                       "So many lines, fly-back not counted: whole frames, so some more")
          ->check(within<std::uint64_t>(1, most));
  command->add_option("--volumes", a.volumes, "So many volumes (1 if not given)")
      ->check(within<std::uint64_t>(1, most))
      ->excludes(lines);
  command->add_flag("--average", a.average,
                    "Keep one line, the mean of all, fly-back not counted (f32): for darks");
  add_source_options(*command, a);
  command->footer("Examples:\n"
                  "  octascope capture --out near.h5 --lines 3000\n"
                  "  octascope capture --out dark.h5 --lines 10000 --average\n"
                  "  octascope capture --out eye.h5 --volumes 4 --sim --phantom eye\n"
                  "octascope calibrate, reconstruct, render and run --spectra take them; octascope "
                  "info tells of them.");
  command->callback([arguments, &exit_status] { exit_status = run(*arguments); });
}

} // namespace octascope::firmware_host
