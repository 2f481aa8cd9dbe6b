#include <algorithm>
#include <optional>

#include <fmt/format.h>

#include "firmware-host/capture/capture.h"
#include "firmware-host/commands/calibrate/calibrate_inputs.h"
#include "firmware-host/commands/commission/live_look.h"
#include "firmware-host/commands/commission/spectrum_text.h"
#include "firmware-host/commands/commission/steps.h"
#include "firmware-host/run/stop_signal.h"
#include "pipeline/calibration_finder/mirror_pair.h"

namespace octascope::firmware_host {

namespace {

constexpr std::uint64_t averaged_lines = 3000;

using Line = std::vector<double>;

struct AveragedCapture {
  std::filesystem::path file;
  Line line;
  StepRecord record;
};

hal::Result<> capture_to(const CaptureOptions& options) {
  StopSignal stop_signal;
  return capture(options, stop_signal);
}

// A look, which tells of saturation, and the mean of many lines.
hal::Result<AveragedCapture> capture_mean(Bench& bench, std::string_view stem,
                                          const std::string& phantom) {
  HAL_TRY(const auto options, bench.session.run_options(phantom));
  HAL_TRY(const auto configuration, bench.session.configuration());
  HAL_TRY(const auto seen, look(options, configuration, 1, bench.clock));
  AveragedCapture captured;
  add_quality(captured.record, seen);
  captured.file = bench.session.free_file(stem, ".h5");
  HAL_CHECK(capture_to(
      {.run = options, .file = captured.file, .lines = averaged_lines, .average = true}));
  HAL_TRY(captured.line, read_spectrum(captured.file, {}, false));
  const auto picture = bench.session.free_file(stem, ".png");
  HAL_CHECK(pipeline::write_png(
      picture, draw_spectrum(captured.line, seen.one_line, seen.format.full_scale())));
  captured.record.found.emplace_back("file", captured.file.filename().string());
  captured.record.pictures.push_back(picture.filename().string());
  const double contrast =
      pipeline::judge_spectra(captured.line, captured.line.size(), seen.format.full_scale())
          .contrast;
  captured.record.found.emplace_back("contrast of the mean",
                                     fmt::format("{:.1f} %", contrast * 100));
  if (stem != "dark" && contrast < seen.quality.contrast / 2)
    captured.record.warnings.emplace_back(
        "the mean of the lines has lost most of the fringe: hold beam and mirror still, with the "
        "scanner parked or the mirror level");
  return captured;
}

hal::Result<Line> without_dark(Bench& bench, Line line) {
  const auto file = bench.session.file("dark");
  if (!file)
    return line;
  HAL_TRY(const auto dark, read_spectrum(*file, {}, false));
  if (dark.size() != line.size())
    return hal::fail(hal::ErrorCode::bad_data,
                     "the dark has {} samples, this line {}: repeat the step \"dark\"", dark.size(),
                     line.size());
  std::ranges::transform(line, dark, line.begin(), std::minus<>{});
  return line;
}

hal::Result<AveragedCapture> capture_mirror(Bench& bench, std::string_view stem,
                                            const std::string& what) {
  HAL_TRY(const auto phantom, ask_to_place(bench, what, std::string{stem}));
  HAL_TRY(auto captured, capture_mean(bench, stem, phantom));
  HAL_TRY(captured.line, without_dark(bench, std::move(captured.line)));
  HAL_TRY(const auto fringe,
          pipeline::find_fringe(captured.line, captured.file.filename().string()));
  bench.session.set(stem, captured.file.filename().string());
  return captured;
}

} // namespace

hal::Result<StepRecord> capture_dark(Bench& bench) {
  HAL_TRY(const auto phantom,
          ask_to_place(bench, "Block the sample arm; the reference arm stays.", "dark"));
  HAL_TRY(auto captured, capture_mean(bench, "dark", phantom));
  if (pipeline::find_fringe(captured.line, "dark"))
    return hal::fail(hal::ErrorCode::bad_data,
                     "{}: this is no dark: there is a fringe in it, expected the reference arm's "
                     "light alone; block the sample arm and repeat",
                     captured.file.filename().string());
  bench.session.set("dark", captured.file.filename().string());
  return captured.record;
}

hal::Result<StepRecord> capture_near_mirror(Bench& bench) {
  HAL_TRY(auto captured,
          capture_mirror(bench, "mirror_near",
                         "Lay a mirror at about a tenth to a fifth of the depth range."));
  return captured.record;
}

hal::Result<StepRecord> capture_far_mirror(Bench& bench) {
  HAL_TRY(auto captured,
          capture_mirror(bench, "mirror_far",
                         "Move the mirror to about half of the depth range, and note by how far."));
  if (const auto near = bench.session.file("mirror_near")) {
    HAL_TRY(auto first, read_spectrum(*near, {}, false));
    HAL_TRY(first, without_dark(bench, std::move(first)));
    HAL_TRY(const auto pair, pipeline::find_mirror_pair(first, captured.line));
    captured.record.found.emplace_back(
        "depths", fmt::format("{:.1f} and {:.1f} bins", pair.depth_bins[0], pair.depth_bins[1]));
  }
  return captured.record;
}

hal::Result<std::filesystem::path> capture_volume(Bench& bench, std::string_view stem,
                                                  const std::string& phantom) {
  HAL_TRY(const auto options, bench.session.run_options(phantom));
  const auto file = bench.session.free_file(stem, ".h5");
  HAL_CHECK(capture_to({.run = options, .file = file, .lines = {}, .volumes = 1}));
  return file;
}

hal::Result<StepRecord> capture_tissue(Bench& bench) {
  HAL_TRY(const auto phantom,
          ask_to_place(bench,
                       "Lay tissue, a fingertip or tape under the beam, well within the range.",
                       "anterior_eye"));
  HAL_TRY(const auto file, capture_volume(bench, "tissue", phantom));
  bench.session.set("tissue", file.filename().string());
  return StepRecord{.found = {{"file", file.filename().string()}}, .warnings = {}, .pictures = {}};
}

} // namespace octascope::firmware_host
