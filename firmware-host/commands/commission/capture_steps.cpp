#include <algorithm>
#include <optional>

#include <fmt/format.h>

#include "firmware-host/capture/capture.h"
#include "firmware-host/commands/calibrate/calibrate_inputs.h"
#include "firmware-host/commands/commission/live_look.h"
#include "firmware-host/commands/commission/spectrum_text.h"
#include "firmware-host/commands/commission/steps.h"
#include "firmware-host/run/stop_signal.h"
#include "firmware-host/terminal/terminal.h"
#include "pipeline/calibration_finder/depth_power.h"
#include "pipeline/calibration_finder/mirror_pair.h"

namespace octascope::firmware_host {

namespace {

constexpr std::uint64_t averaged_lines = 3000;

using Line = std::vector<double>;

struct AveragedCapture {
  std::filesystem::path file;
  Line line;
  double contrast = 0; // of the line
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
  captured.contrast =
      pipeline::judge_spectra(captured.line, captured.line.size(), seen.format.full_scale())
          .contrast;
  captured.record.found.emplace_back(
      "contrast of the mean",
      fmt::format("{:.1f} % over {} lines or more", captured.contrast * 100, averaged_lines));
  const bool has_fringe = seen.quality.contrast >= least_mirror_contrast;
  if (stem != "dark" && has_fringe && captured.contrast < seen.quality.contrast / 2)
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

// A capture that is hardly what it should be: kept if so wished, with a warning.
hal::Result<> ask_to_keep(Bench& bench, StepRecord& record, const std::string& doubt) {
  say("  WARNING: {}\n", doubt);
  HAL_TRY(const auto kept, bench.dialogue.ask_word("Keep it all the same?", {"no", "yes"}));
  if (kept == "no")
    return hal::fail(hal::ErrorCode::bad_data, "{}", doubt);
  record.warnings.push_back(doubt);
  return {};
}

hal::Result<> judge_mirror(Bench& bench, AveragedCapture& captured) {
  const std::string name = captured.file.filename().string();
  const std::string seen = fmt::format("contrast of the mean {:.1f} %, expected {:.0f} % or more",
                                       captured.contrast * 100, least_mirror_contrast * 100);
  constexpr const char* remedy = "is the mirror in the beam, in focus, within the depth range and "
                                 "still, and are both arms open?";
  if (const auto fringe = pipeline::find_fringe(captured.line, "the mean"); !fringe)
    return hal::fail(hal::ErrorCode::bad_data, "{}: this is no mirror: {}; {} ({})", name, seen,
                     remedy, fringe.error().message);
  if (captured.contrast < least_mirror_contrast)
    return ask_to_keep(bench, captured.record,
                       fmt::format("{}: this is hardly a mirror: {}; {}", name, seen, remedy));
  return {};
}

hal::Result<AveragedCapture> capture_mirror(Bench& bench, std::string_view stem,
                                            const std::string& what) {
  HAL_TRY(const auto phantom, ask_to_place(bench, what, std::string{stem}));
  HAL_TRY(auto captured, capture_mean(bench, stem, phantom));
  HAL_TRY(captured.line, without_dark(bench, std::move(captured.line)));
  HAL_CHECK(judge_mirror(bench, captured));
  bench.session.set(stem, captured.file.filename().string());
  return captured;
}

// Some B-scans of it, evenly chosen.
hal::Result<> judge_tissue(Bench& bench, const std::filesystem::path& file, StepRecord& record) {
  constexpr int judged_b_scans = 5;
  constexpr double least_above_noise_db = 6;
  HAL_TRY(const auto tissue, open_tissue(file, {}));
  const auto& shape = tissue.shape();
  pipeline::DepthPower power{static_cast<std::size_t>(shape.samples)};
  const int judged = std::min(judged_b_scans, shape.b_scans);
  for (int i = 0; i < judged; ++i)
    power.add_b_scan(
        to_numbers(tissue.b_scan((2 * i + 1) * shape.b_scans / (2 * judged)), tissue.type()));
  const auto highest = power.highest();
  record.found.emplace_back("brightest depth",
                            fmt::format("{:.1f} dB above the noise, at depth bin {} of {}",
                                        highest.above_noise_db, highest.bin, shape.samples / 2));
  if (highest.above_noise_db >= least_above_noise_db)
    return {};
  return ask_to_keep(
      bench, record,
      fmt::format(
          "{}: this is no tissue: nothing stands out of the noise at any depth, the most "
          "by {:.1f} dB, expected {:.0f} dB or more; is it in the beam, in focus and within "
          "the depth range, and are both arms open?",
          file.filename().string(), highest.above_noise_db, least_above_noise_db));
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
        "depths",
        fmt::format("{:.1f} and {:.1f} depth bins", pair.depth_bins[0], pair.depth_bins[1]));
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
  StepRecord record{.found = {{"file", file.filename().string()}}, .warnings = {}, .pictures = {}};
  HAL_CHECK(judge_tissue(bench, file, record));
  bench.session.set("tissue", file.filename().string());
  return record;
}

} // namespace octascope::firmware_host
