#include <cstdio>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "firmware-host/commands/arguments.h"
#include "firmware-host/commands/command.h"
#include "firmware-host/commands/numbers.h"
#include "firmware-host/commands/recordings/export.h"
#include "firmware-host/report/progress_line.h"
#include "firmware-host/terminal/terminal.h"
#include "pipeline/files/file_name.h"
#include "pipeline/volume/level_scale.h"

namespace octascope::firmware_host {

namespace {

// As text, the way CLI11 collects it.
struct ExportCommandLine {
  std::string file, to, out, volumes, window, subject;
  int b_scan = 0;
  bool u8 = false, to_scale = false;
  CLI::Option *b_scan_given = nullptr, *subject_given = nullptr;
};

struct Format {
  const char* extension;
  ExportFormat format;
};

const std::map<std::string, Format>& formats() {
  static const std::map<std::string, Format> all{{"nrrd", {".nrrd", ExportFormat::nrrd}},
                                                 {"dicom", {".dcm", ExportFormat::dicom}},
                                                 {"png", {".png", ExportFormat::png}}};
  return all;
}

hal::Result<ExportFormat> format_of(const ExportCommandLine& line) {
  if (!line.to.empty())
    return formats().at(line.to).format;
  for (const auto& [word, format] : formats()) {
    if (pipeline::file_ending(line.out) == format.extension)
      return format.format;
  }
  return hal::fail(hal::ErrorCode::invalid_argument,
                   "--to is missing, and --out {} does not tell it; expected nrrd, dicom or png",
                   line.out);
}

// Options that mean nothing to the chosen format.
hal::Result<> check_use(const ExportCommandLine& line, ExportFormat format) {
  const auto only_for = [](std::string_view option, std::string_view words) {
    return hal::fail(hal::ErrorCode::invalid_argument, "{} is for --to {} only", option, words);
  };
  if (line.u8 && format != ExportFormat::nrrd)
    return only_for("--u8", "nrrd");
  if (!line.b_scan_given->empty() && format != ExportFormat::png)
    return only_for("--bscan", "png");
  if (line.to_scale && format != ExportFormat::png)
    return only_for("--to-scale", "png");
  if (!line.window.empty() && format == ExportFormat::nrrd)
    return only_for("--window", "dicom and --to png");
  if (!line.subject_given->empty() && format == ExportFormat::png)
    return only_for("--subject", "nrrd and --to dicom");
  return {};
}

hal::Result<ExportOptions> options_of(const ExportCommandLine& line) {
  HAL_TRY(const auto format, format_of(line));
  HAL_CHECK(check_use(line, format));
  ExportOptions options;
  options.recording = line.file;
  options.format = format;
  options.out = line.out;
  options.display_counts = line.u8;
  options.to_scale = line.to_scale;
  if (!line.b_scan_given->empty())
    options.b_scan = line.b_scan;
  if (!line.subject_given->empty())
    options.subject = line.subject;
  if (!line.volumes.empty()) {
    HAL_TRY(const auto volumes, parse_volumes(line.volumes));
    options.volumes = volumes;
  }
  if (!line.window.empty()) {
    HAL_TRY(const auto window, parse_window(line.window));
    options.window = window;
  }
  return options;
}

void tell(const ExportOutcome& outcome) {
  if (outcome.volumes == 1)
    say("{}: 1 volume\n", outcome.first.string());
  else
    say("{} to {}: {} volumes\n", outcome.first.string(), outcome.last.filename().string(),
        outcome.volumes);
  if (outcome.simulated)
    say("SIMULATED: some or all of it is not the patient's\n");
  if (outcome.window)
    say("black is {:.1f} dB, white {:.1f} dB\n", outcome.window->offset_db,
        outcome.window->offset_db + outcome.window->size_db);
  if (!outcome.pixels.empty())
    say("{}\n", outcome.pixels);
  if (!outcome.assumed_spacings.empty())
    warn("octascope export: warning: spacings are assumed, not measured: {}\n",
         outcome.assumed_spacings);
  if (outcome.missing_b_scans > 0)
    warn("octascope export: warning: {} B-scans are missing in the recording; in the files "
         "they are at the lowest level, {} dB\n",
         outcome.missing_b_scans, pipeline::lowest_level_db);
}

int run(const ExportCommandLine& line) {
  const auto exported = options_of(line).and_then([&](const ExportOptions& options) {
    ProgressLine progress{fmt::format("exporting {}", line.file)};
    return export_recording(options, [&](double done) { progress.update(done); });
  });
  if (!exported)
    return complain("export", exported.error());
  tell(*exported);
  return exit_done;
}

void add_picture_options(CLI::App& command, ExportCommandLine& line) {
  line.b_scan_given = command
                          .add_option("--bscan", line.b_scan,
                                      "PNG: the B-scan to draw, from 0; without it the volume is "
                                      "drawn from above (en face)")
                          ->check(within(0, 65535))
                          ->type_name("I");
  command
      .add_option("--window", line.window,
                  "DICOM and PNG: where the display window begins and its size, in dB, as 8,36; "
                  "without it what suits the first chosen volume, for all of them")
      ->type_name("L,S");
  command.add_flag("--to-scale", line.to_scale,
                   "PNG: square pixels; without it one pixel a level or A-scan, as stored");
}

} // namespace

void add_export_command(CLI::App& program, int& exit_status) {
  auto line = std::make_shared<ExportCommandLine>();
  CLI::App* command =
      program.add_subcommand("export", "Volumes of a recording as NRRD, DICOM or PNG files");
  command->add_option("file", line->file, "Recording")->required()->type_name("FILE.h5");
  std::vector<std::string> words;
  for (const auto& [word, format] : formats())
    words.push_back(word);
  command
      ->add_option("--to", line->to,
                   "nrrd: a volume of levels; dicom: a multi-frame image, a frame a B-scan; png: a "
                   "picture. Without it, the ending of --out tells: .nrrd, .dcm, .png")
      ->check(CLI::IsMember(words))
      ->type_name("nrrd|dicom|png")
      ->option_text("nrrd|dicom|png");
  command
      ->add_option("--out", line->out,
                   "For one volume a file that ends with .nrrd, .dcm or .png; else a folder, made "
                   "where it is missing, with a file for each: volume-0012.nrrd. Files of these "
                   "names are replaced")
      ->required()
      ->type_name("PATH");
  command
      ->add_option("--volumes,--volume", line->volumes,
                   "One, counted from 0 (12), or a range (10-20, or 10- to the last); all of them "
                   "if not given")
      ->type_name("N|A-B");
  add_picture_options(*command, *line);
  command->add_flag("--u8", line->u8, "NRRD: the display's 8-bit counts instead of float dB");
  line->subject_given =
      command
          ->add_option("--subject", line->subject,
                       "DICOM and NRRD: who the files say it shows, instead of the recording's "
                       "subject; \"\" says nothing")
          ->type_name("TEXT");
  command->footer("Files appear complete or not at all, and only their owner may read them: they "
                  "show a patient.\n"
                  "Examples:\n"
                  "  octascope export recording.h5 --to dicom --out series\n"
                  "  octascope export recording.h5 --volumes 12 --out volume.nrrd\n"
                  "  octascope export recording.h5 --volumes 10-20 --to png --bscan 40 \\\n"
                  "    --window 8,36 --to-scale --out pictures");
  command->callback([line, &exit_status] { exit_status = run(*line); });
}

} // namespace octascope::firmware_host
