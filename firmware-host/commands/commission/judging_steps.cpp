// What the captures give: the calibration, and what a target says of it.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "firmware-host/commands/calibrate/calibrate.h"
#include "firmware-host/commands/commission/steps.h"
#include "firmware-host/commands/level_picture.h"
#include "firmware-host/commands/volume/reconstruct.h"
#include "firmware-host/terminal/terminal.h"
#include "pipeline/calibration_finder/target.h"
#include "pipeline/files/nrrd.h"
#include "pipeline/files/png_image.h"
#include "pipeline/volume/level_scale.h"

namespace octascope::firmware_host {

namespace {

constexpr double simulated_mirrors_apart_um = 630;
constexpr double broad_fwhm_bins = 2.5;
constexpr double other_spacing = 0.1; // by so large a share a spacing is not what was meant

hal::Result<std::filesystem::path> captured_file(const Bench& bench, std::string_view key,
                                                 std::string_view step) {
  const auto file = bench.session.file(key);
  if (!file)
    return hal::fail(hal::ErrorCode::invalid_argument,
                     "there is no {} yet: the step \"{}\" was skipped; the same command with the "
                     "same folder asks for it again",
                     key, step);
  return *file;
}

void add_verdict(StepRecord& record, const CalibrationVerdict& verdict) {
  for (std::size_t i = 0; i < verdict.mirrors.size(); ++i) {
    const MirrorVerdict& mirror = verdict.mirrors[i];
    record.found.emplace_back(
        fmt::format("{} mirror", i == 0 ? "near" : "far"),
        fmt::format("at depth bin {:.1f}, {:.2f} bins wide (FWHM; {:.1f} without the calibration), "
                    "level {:.1f} dB",
                    mirror.peak_bins, mirror.fwhm_after_bins, mirror.fwhm_before_bins,
                    mirror.level_after_db));
    if (!(mirror.fwhm_after_bins <= broad_fwhm_bins))
      record.warnings.push_back(
          fmt::format("the {} mirror is {:.2f} bins wide, expected at most {}: repeat the mirrors "
                      "with more light, or farther apart",
                      i == 0 ? "near" : "far", mirror.fwhm_after_bins, broad_fwhm_bins));
  }
  record.found.emplace_back("phase residual",
                            fmt::format("{:.3f} rad about a smooth curve", verdict.residual_rad()));
  record.found.emplace_back("depth error",
                            fmt::format("{:.2f} depth bins", verdict.depth_error_bins()));
  record.found.emplace_back("roll-off",
                            fmt::format("{:.3f} dB a depth bin", verdict.roll_off_db_per_bin()));
  record.found.emplace_back("side of zero delay",
                            fmt::format("{}, {}", verdict.sample_side, verdict.side_source));
  // A tissue that is none finds one as well, and all but the depths looks right.
  if (verdict.mirrors.size() == 2 && verdict.sample_side.starts_with("the "))
    record.warnings.push_back(
        fmt::format("the mirrors lay on either side of zero delay, if the tissue is right: only {} "
                    "on its side. If they lay on one side, take the tissue again, sharp and in the "
                    "beam, and then this; else the depths are wrong",
                    verdict.sample_side));
  record.found.emplace_back(
      "depth spacing", verdict.spacing_um
                           ? fmt::format("{:.3f} µm in air from bin to bin", *verdict.spacing_um)
                           : "not known: the mirrors' distance was not said");
}

// A B-scan of the tissue with what was found.
hal::Result<> draw_tissue(Bench& bench, const std::filesystem::path& calibration,
                          StepRecord& record) {
  const auto tissue = bench.session.file("tissue");
  if (!tissue)
    return {};
  const auto picture = bench.session.free_file("tissue", ".png");
  ReconstructOptions options;
  options.spectra = *tissue;
  options.calibration = calibration;
  options.volume = bench.session.free_file("tissue", ".nrrd");
  options.display_counts = true;
  options.picture_b_scan = static_cast<int>(bench.session.number("b_scans", 80)) / 2;
  options.picture = picture;
  HAL_CHECK(reconstruct_volume(options));
  record.pictures.push_back(picture.filename().string());
  return {};
}

std::vector<float> brightest_along_depth(const std::vector<std::uint8_t>& levels,
                                         const pipeline::VolumeGeometry& geometry) {
  const auto depths = static_cast<std::size_t>(geometry.depths);
  const std::size_t first = std::min<std::size_t>(8, depths / 2); // beyond what the background left
  std::vector<float> en_face(levels.size() / depths);
  for (std::size_t i = 0; i < en_face.size(); ++i)
    en_face[i] = pipeline::level_db(
        *std::max_element(levels.begin() + static_cast<std::ptrdiff_t>(i * depths + first),
                          levels.begin() + static_cast<std::ptrdiff_t>((i + 1) * depths)));
  return en_face;
}

hal::Result<> draw_target(Bench& bench, std::span<const float> en_face,
                          const pipeline::VolumeGeometry& geometry, StepRecord& record) {
  float low = 1e9F;
  float high = -1e9F;
  for (const float level : en_face) {
    low = std::min(low, level);
    high = std::max(high, level);
  }
  pipeline::Image grey{geometry.a_scans, geometry.b_scans, 1};
  std::ranges::transform(en_face, grey.pixels.begin(), [low, high](float level) {
    return static_cast<std::uint8_t>(255 * (level - low) / std::max(high - low, 1.0F));
  });
  HAL_TRY(const auto scaled, to_scale(grey, geometry.a_spacing_um, geometry.b_spacing_um));
  const auto picture = bench.session.free_file("target", ".png");
  HAL_CHECK(pipeline::write_png(picture, scaled));
  record.pictures.push_back(picture.filename().string());
  return {};
}

// Before it is asked whether they are to be taken.
void warn_of_other_spacings(const pipeline::TargetMeasurement& measured, double a_said_um,
                            double b_said_um, StepRecord& record) {
  const auto is_other = [](double found, double said) {
    return std::abs(found - said) > other_spacing * said;
  };
  if (!is_other(measured.a_spacing_um, a_said_um) && !is_other(measured.b_spacing_um, b_said_um))
    return;
  record.warnings.push_back(fmt::format(
      "measured spacings differ by more than {:.0f} % from what was said: is the target's side "
      "right, and the scan's width?",
      100 * other_spacing));
  say("  WARNING: {}\n", record.warnings.back());
}

hal::Result<> ask_about_spacings(Bench& bench, const pipeline::TargetMeasurement& measured,
                                 StepRecord& record) {
  HAL_TRY(
      const auto use,
      bench.dialogue.ask_word(
          fmt::format("Measured: {:.2f} µm between A-scans, {:.2f} µm between B-scans. Use them?",
                      measured.a_spacing_um, measured.b_spacing_um),
          {"yes", "no"}));
  record.found.emplace_back("taken", use);
  if (use == "yes") {
    bench.session.set("a_spacing_um", measured.a_spacing_um);
    bench.session.set("b_spacing_um", measured.b_spacing_um);
  }
  return {};
}

} // namespace

hal::Result<StepRecord> calibrate_from_captures(Bench& bench) {
  HAL_TRY(const auto near, captured_file(bench, "mirror_near", "mirror near"));
  HAL_TRY(const auto far, captured_file(bench, "mirror_far", "mirror far"));
  const double fallback = bench.session.number(
      "mirrors_apart_um", bench.session.simulated() ? simulated_mirrors_apart_um : 0);
  HAL_TRY(const double apart_um,
          bench.dialogue.ask_number("How far apart were the mirrors, in µm (0: not known)?",
                                    fallback, 0, 1e6));
  CalibrateOptions options;
  options.mirrors = {near, far};
  if (const auto dark = bench.session.file("dark"))
    options.darks.plain = {*dark};
  options.tissue = bench.session.file("tissue");
  if (apart_um > 0)
    options.mirror_distance_um = apart_um;
  options.camera = bench.session.text("camera");
  options.out = bench.session.free_file("calibration", ".toml");
  options.picture = bench.session.free_file("calibration", ".png");
  HAL_TRY(const auto verdict, calibrate(options));
  StepRecord record;
  add_verdict(record, verdict);
  record.found.emplace_back("mirrors moved by", apart_um > 0
                                                    ? fmt::format("{:g} µm, as was said", apart_um)
                                                    : "not known");
  record.found.emplace_back("file", options.out.filename().string());
  record.pictures.push_back(options.picture->filename().string());
  bench.session.set("mirrors_apart_um", apart_um);
  bench.session.set("calibration", options.out.filename().string());
  if (const auto drawn = draw_tissue(bench, options.out, record); !drawn)
    record.warnings.push_back("the tissue could not be drawn: " + drawn.error().message);
  return record;
}

hal::Result<StepRecord> check_target(Bench& bench) {
  HAL_TRY(const auto phantom,
          ask_to_place(bench,
                       "Lay the target under the beam, upright as the surgeon sees it, tilted "
                       "by a degree or two.",
                       "target"));
  HAL_TRY(const double side_mm, bench.dialogue.ask_number("Side of the target's square, in mm?",
                                                          pipeline::target_side_mm, 0.01, 1000));
  HAL_TRY(const auto file, capture_volume(bench, "target", phantom)); // with its calibration
  const auto volume = bench.session.free_file("target", ".nrrd");
  ReconstructOptions options;
  options.spectra = file;
  options.volume = volume;
  options.display_counts = true;
  HAL_CHECK(reconstruct_volume(options));
  HAL_TRY(const auto read, pipeline::read_nrrd(volume));
  const auto& geometry = read.geometry;
  const auto en_face =
      brightest_along_depth(std::get<std::vector<std::uint8_t>>(read.levels), geometry);
  StepRecord record;
  HAL_CHECK(draw_target(bench, en_face, geometry, record));
  auto found =
      pipeline::measure_target(en_face, geometry.a_scans, geometry.b_scans, side_mm * 1000);
  if (!found)
    return hal::fail(found.error().code, "{} {} shows what was seen", found.error().message,
                     (bench.session.folder() / record.pictures.front()).string());
  const pipeline::TargetMeasurement measured = *found;
  const double a_before = bench.session.number("a_spacing_um", geometry.a_spacing_um);
  const double b_before = bench.session.number("b_spacing_um", geometry.b_spacing_um);
  record.found = {
      {"orientation", pipeline::orientation_text(measured)},
      {"agreement", fmt::format("{:.2f} with the drawing (1: perfect), the next best way "
                                "round {:.2f}",
                                measured.agreement, measured.runner_up)},
      {"side of its square", fmt::format("{:g} mm, as was said", side_mm)},
      {"A-scans apart", fmt::format("{:.2f} µm measured, {:.2f} µm in the scan's settings",
                                    measured.a_spacing_um, a_before)},
      {"B-scans apart", fmt::format("{:.2f} µm measured, {:.2f} µm in the scan's settings",
                                    measured.b_spacing_um, b_before)},
      {"file", file.filename().string()}};
  if (!measured.upright())
    record.warnings.push_back(
        fmt::format("the picture is {}: swap the scanner's axes, or the sign of one, until the "
                    "target is upright",
                    pipeline::orientation_text(measured)));
  warn_of_other_spacings(measured, a_before, b_before, record);
  HAL_CHECK(ask_about_spacings(bench, measured, record));
  return record;
}

} // namespace octascope::firmware_host
