#include "firmware-host/commands/calibrate/calibrate.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "firmware-host/commands/calibrate/calibrate_inputs.h"
#include "firmware-host/commands/calibrate/calibrate_picture.h"
#include "firmware-host/version/version.h"
#include "pipeline/calibration/calibration_writer.h"
#include "pipeline/calibration_finder/lamp_lines.h"
#include "pipeline/calibration_finder/tissue_sharpness.h"
#include "pipeline/recordings/raw/raw_reader.h"

namespace octascope::firmware_host {

namespace {

using hal::ErrorCode;
using pipeline::Calibration;
using pipeline::KTable;
using pipeline::SampleSide;

std::string_view name_of(SampleSide side) {
  switch (side) {
  case SampleSide::both_mirrors: return "both mirrors";
  case SampleSide::first_mirror: return "the first mirror";
  case SampleSide::second_mirror: return "the second mirror";
  case SampleSide::no_mirror: break;
  }
  return "no mirror";
}

// One run of the command: the steps fill the verdict and what will be written.
class CalibrationRun {
public:
  explicit CalibrationRun(const CalibrateOptions& options) : options_(options) {}

  hal::Result<CalibrationVerdict> run();

private:
  hal::Result<> use_base();
  hal::Result<> use_lamp();
  hal::Result<> use_mirrors();
  hal::Result<> read_tissue();
  hal::Result<> use_tissue();
  pipeline::TissueDispersion dispersion_with(const Calibration& calibration) const;
  void judge_table(pipeline::TissueDispersion& dispersion);
  hal::Result<std::vector<double>> read(const std::filesystem::path& file, bool refuse_saturated);
  hal::Result<> subtract_darks(std::size_t mirror, std::vector<double>& line);
  hal::Result<> choose_side(const std::array<pipeline::Fringe, 2>& fringes);
  void judge_mirrors();
  void judge_curves();
  hal::Result<> write();
  void adopt(const pipeline::MirrorPair& pair);
  double sharpness(const Calibration& calibration, bool with_dispersion) const;

  const CalibrateOptions& options_;
  int samples_ = 0; // 0: the first file says
  pipeline::FoundCalibration found_;
  CalibrationVerdict verdict_;
  std::array<MirrorMeasurement, 2> mirrors_;
  std::optional<pipeline::MirrorPair> pair_;
  std::vector<std::vector<double>> tissue_b_scans_;
  std::vector<std::string> inputs_;
};

hal::Result<std::vector<double>> CalibrationRun::read(const std::filesystem::path& file,
                                                      bool refuse_saturated) {
  SpectrumInput input{options_.samples, options_.type, options_.significant_bits};
  auto spectrum = read_spectrum(file, input, refuse_saturated);
  if (!spectrum)
    return spectrum;
  const auto found = static_cast<int>(spectrum->size());
  if (samples_ == 0)
    samples_ = found;
  if (found != samples_)
    return hal::fail(
        ErrorCode::bad_data,
        "{}: has {} samples, the files before it {}; say with --samples how many make one line",
        file.string(), found, samples_);
  // A dark that both mirrors share is read twice.
  const std::string name = file.filename().string();
  if (std::ranges::find(inputs_, name) == inputs_.end())
    inputs_.push_back(name);
  return spectrum;
}

hal::Result<> CalibrationRun::subtract_darks(std::size_t mirror, std::vector<double>& line) {
  struct Term {
    std::filesystem::path file;
    double factor;
  };
  const DarkFiles& darks = options_.darks;
  std::vector<Term> terms;
  for (const auto& file : darks.plain)
    terms.push_back({file, -1.0 / static_cast<double>(darks.plain.size())});
  if (darks.reference)
    terms.push_back({*darks.reference, -1});
  if (!darks.sample.empty())
    terms.push_back({darks.sample[darks.sample.size() == 2 ? mirror : 0], -1});
  // Each arm's spectrum contains the dark: with both it was taken away twice, with none not once.
  const bool twice = darks.reference && !darks.sample.empty();
  const bool not_once = !darks.reference && darks.sample.empty();
  if (darks.none && (twice || not_once))
    terms.push_back({*darks.none, twice ? 1.0 : -1.0});
  for (const Term& term : terms) {
    HAL_TRY(const auto dark, read(term.file, false));
    for (std::size_t p = 0; p < line.size(); ++p)
      line[p] += term.factor * dark[p];
  }
  return {};
}

void CalibrationRun::adopt(const pipeline::MirrorPair& pair) {
  found_.calibration = Calibration::identity(samples_);
  found_.calibration.positions = pair.positions;
  found_.calibration.dispersion_rad = pair.dispersion_rad;
}

double CalibrationRun::sharpness(const Calibration& calibration, bool with_dispersion) const {
  pipeline::TissueSharpness measure{calibration};
  for (const auto& b_scan : tissue_b_scans_)
    measure.add_b_scan(b_scan);
  return measure.measure(with_dispersion ? std::span<const double>{calibration.dispersion_rad}
                                         : std::span<const double>{});
}

// Without word of the user, the side that makes the tissue sharpest.
hal::Result<> CalibrationRun::choose_side(const std::array<pipeline::Fringe, 2>& fringes) {
  std::vector<SampleSide> sides{options_.side.value_or(SampleSide::both_mirrors)};
  const bool ask_tissue = options_.tissue && !options_.side;
  verdict_.side_source = options_.side ? "as given"
                         : ask_tissue  ? "by the tissue's sharpness"
                                       : "assumed; --tissue or --sample-side can tell";
  if (ask_tissue)
    sides = {SampleSide::both_mirrors, SampleSide::no_mirror, SampleSide::first_mirror,
             SampleSide::second_mirror};
  double best = -1;
  std::optional<hal::Error> error;
  for (const SampleSide side : sides) {
    auto pair = pipeline::combine_fringes(fringes, side);
    if (!pair) {
      error = error.value_or(pair.error());
      continue;
    }
    adopt(*pair);
    const double value = ask_tissue ? sharpness(found_.calibration, true) : 0;
    if (value > best) {
      best = value;
      pair_ = std::move(*pair);
      verdict_.sample_side = name_of(side);
    }
  }
  if (!pair_)
    return tl::make_unexpected(*error);
  adopt(*pair_);
  return {};
}

hal::Result<> CalibrationRun::use_mirrors() {
  std::vector<pipeline::Fringe> fringes;
  for (std::size_t i = 0; i < 2; ++i) {
    HAL_TRY(auto line, read(options_.mirrors[i], true));
    HAL_CHECK(subtract_darks(i, line));
    HAL_TRY(auto fringe, pipeline::find_fringe(line, options_.mirrors[i].string()));
    mirrors_[i].interferogram = pipeline::remove_slow_part(line);
    fringes.push_back(std::move(fringe));
  }
  HAL_CHECK(choose_side({fringes[0], fringes[1]}));
  verdict_.method = "pair of mirrors";
  if (options_.tissue)
    verdict_.tissue = TissueVerdict{
        sharpness(found_.calibration, false), sharpness(found_.calibration, true), {}};
  if (options_.mirror_distance_um) {
    // Mirrors on either side of zero delay are as far apart as their depths together.
    const bool opposite = pair_->theta_sign[0] != pair_->theta_sign[1];
    const double bins = opposite ? pair_->depth_bins[0] + pair_->depth_bins[1]
                                 : std::abs(pair_->depth_bins[1] - pair_->depth_bins[0]);
    // Mirrors are moved in air; in a medium the same delay is a shorter way.
    verdict_.refractive_index = options_.refractive_index.value_or(1.0);
    verdict_.spacing_um = *options_.mirror_distance_um / bins / *verdict_.refractive_index;
  }
  judge_mirrors();
  return {};
}

void CalibrationRun::judge_mirrors() {
  const Calibration raw = Calibration::identity(samples_);
  for (std::size_t i = 0; i < 2; ++i) {
    MirrorMeasurement& mirror = mirrors_[i];
    mirror.before = pipeline::measure_axial_psf(mirror.interferogram, raw);
    mirror.after =
        pipeline::measure_axial_psf(mirror.interferogram, found_.calibration, pair_->theta_sign[i]);
    const pipeline::Fringe& fringe = pair_->fringes[i];
    verdict_.mirrors.push_back(
        {options_.mirrors[i].string(), pair_->depth_bins[i], mirror.after.peak_bin,
         mirror.before.fwhm_bins, mirror.after.fwhm_bins, mirror.before.level_db,
         mirror.after.level_db, fringe.residual_rad, static_cast<int>(fringe.first_bright),
         static_cast<int>(fringe.last_bright)});
  }
}

hal::Result<> CalibrationRun::use_lamp() {
  HAL_TRY(const auto spectrum, read(*options_.lamp, true));
  HAL_TRY(auto lamp,
          pipeline::find_lamp_lines(spectrum, options_.lines_nm, options_.lamp->string()));
  HAL_TRY(auto positions, pipeline::positions_from_wavelength(lamp.polynomial_nm, samples_));
  found_.calibration = Calibration::identity(samples_);
  found_.calibration.positions = std::move(positions);
  found_.wavelength_polynomial_nm = lamp.polynomial_nm;
  verdict_.method = "emission lines of a lamp";
  verdict_.lamp = LampVerdict{options_.lines_nm, lamp.pixels, lamp.residuals_nm, lamp.polynomial_nm,
                              lamp.rms_nm};
  return {};
}

hal::Result<> CalibrationRun::use_base() {
  HAL_TRY(auto base, Calibration::load(*options_.base, samples_));
  samples_ = base.samples;
  found_.calibration = std::move(base);
  found_.spacing_known = true;
  verdict_.spacing_um = found_.calibration.depth_spacing_um;
  verdict_.refractive_index = found_.calibration.refractive_index;
  verdict_.method = fmt::format("k curve of {}", options_.base->filename().string());
  inputs_.push_back(options_.base->filename().string());
  return {};
}

// Three B-scans, at a quarter, the half and three quarters.
hal::Result<> CalibrationRun::read_tissue() {
  HAL_TRY(const auto spectra,
          open_tissue(*options_.tissue, {options_.tissue_shape, options_.tissue_type}));
  for (const int quarter : {1, 2, 3}) {
    const int b = spectra.shape().b_scans * quarter / 4;
    if (const auto fault = spectra.find_fault(b))
      return hal::fail(ErrorCode::bad_data, *fault);
    tissue_b_scans_.push_back(to_numbers(spectra.b_scan(b), spectra.type()));
  }
  samples_ = spectra.shape().samples;
  if (options_.samples && *options_.samples != samples_)
    return hal::fail(ErrorCode::invalid_argument,
                     "--samples is {}, --shape has {} samples, expected the same",
                     *options_.samples, samples_);
  inputs_.push_back(options_.tissue->filename().string());
  return {};
}

pipeline::TissueDispersion CalibrationRun::dispersion_with(const Calibration& calibration) const {
  pipeline::TissueSharpness measure{calibration};
  for (const auto& b_scan : tissue_b_scans_)
    measure.add_b_scan(b_scan);
  return pipeline::find_tissue_dispersion(measure, samples_);
}

// A curve the wrong way round leaves twice the chirp, which no dispersion makes up for at more than
// one depth: the tissue stays blurred.
void CalibrationRun::judge_table(pipeline::TissueDispersion& dispersion) {
  constexpr double matters_pixels = 0.5;
  constexpr double clearly = 1.02;
  Calibration& c = found_.calibration;
  if (c.k_table == KTable::none ||
      pipeline::distance_the_other_way_round(c.positions) < matters_pixels)
    return;
  Calibration other = c;
  other.positions = pipeline::invert_curve(c.positions);
  auto other_dispersion = dispersion_with(other);
  const bool said = c.k_table != KTable::unsaid;
  const bool kept_wins = dispersion.sharpness_after > clearly * other_dispersion.sharpness_after;
  const bool other_wins = other_dispersion.sharpness_after > clearly * dispersion.sharpness_after;
  TableVerdict table{c.k_table == KTable::wavenumber ? "wavenumber" : "pixel",
                     "as the file says",
                     dispersion.sharpness_after,
                     other_dispersion.sharpness_after,
                     {}};
  if (said && other_wins)
    table.warning = "the tissue is sharper the other way round: see whether table_gives is right";
  if (!said)
    table.source = kept_wins || other_wins ? "by the tissue's sharpness" : "assumed";
  if (!said && !kept_wins && !other_wins)
    table.warning =
        "the tissue does not tell which way round the table is meant: say table_gives = "
        "\"pixel\" or \"wavenumber\", or take tissue with more structure";
  if (!said && other_wins) {
    table.gives = "wavenumber";
    std::swap(table.sharpness, table.other_sharpness);
    c.positions = std::move(other.positions);
    dispersion = std::move(other_dispersion);
  }
  verdict_.table = std::move(table);
}

hal::Result<> CalibrationRun::use_tissue() {
  auto dispersion = dispersion_with(found_.calibration);
  if (!(dispersion.sharpness_before > 0))
    return hal::fail(
        ErrorCode::bad_data,
        "{}: no interference: the B-scans that were looked at do not change from line to line",
        options_.tissue->string());
  judge_table(dispersion);
  found_.calibration.dispersion_rad = dispersion.theta_rad;
  found_.dispersion_polynomial_rad = dispersion.unit_polynomial_rad;
  verdict_.method += ", dispersion from tissue";
  verdict_.tissue = TissueVerdict{dispersion.sharpness_before, dispersion.sharpness_after,
                                  dispersion.unit_polynomial_rad};
  return {};
}

void CalibrationRun::judge_curves() {
  Calibration& c = found_.calibration;
  verdict_.samples = samples_;
  verdict_.least_step_pixels = samples_;
  for (std::size_t m = 1; m < c.positions.size(); ++m) {
    const double step = std::abs(c.positions[m] - c.positions[m - 1]);
    verdict_.least_step_pixels = std::min(verdict_.least_step_pixels, step);
    verdict_.greatest_step_pixels = std::max(verdict_.greatest_step_pixels, step);
  }
  double squares = 0;
  for (const double theta : c.dispersion_rad)
    squares += theta * theta;
  verdict_.dispersion_rms_rad = std::sqrt(squares / samples_);
  if (!options_.camera.empty())
    c.camera = options_.camera;
  if (options_.spacing_um) {
    verdict_.spacing_um = options_.spacing_um;
    verdict_.refractive_index = options_.refractive_index;
  }
  if (verdict_.spacing_um) {
    c.depth_spacing_um = *verdict_.spacing_um;
    c.refractive_index = verdict_.refractive_index;
    found_.spacing_known = true;
  }
}

hal::Result<> CalibrationRun::write() {
  found_.provenance = {
      fmt::format("octascope {}", version()), verdict_.method,
      fmt::format("{}", fmt::join(inputs_, ", ")),
      fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::chrono::system_clock::to_time_t(
                                               std::chrono::system_clock::now()))),
      summary(verdict_)};
  verdict_.file = options_.out.string();
  // The picture first: without it there is no calibration either, and the calibration counts.
  if (options_.picture) {
    const auto image =
        pair_ ? draw_mirrors(mirrors_, *pair_)
              : draw_curves(found_.calibration.positions, found_.calibration.dispersion_rad);
    HAL_CHECK(pipeline::write_png(*options_.picture, image));
  }
  auto written = pipeline::write_calibration(found_, options_.out);
  if (!written && options_.picture) {
    std::error_code ignored;
    std::filesystem::remove(*options_.picture, ignored);
  }
  return written;
}

hal::Result<CalibrationVerdict> CalibrationRun::run() {
  const auto step = [this](bool wanted, hal::Result<> (CalibrationRun::*action)()) {
    return [this, wanted, action]() -> hal::Result<> {
      return wanted ? (this->*action)() : hal::Result<>{};
    };
  };
  samples_ = options_.samples.value_or(0);
  const bool tissue_gives_dispersion = options_.tissue && options_.mirrors.empty();
  HAL_CHECK(check(options_)
                .and_then(step(options_.tissue.has_value(), &CalibrationRun::read_tissue))
                .and_then(step(options_.base.has_value(), &CalibrationRun::use_base))
                .and_then(step(options_.lamp.has_value(), &CalibrationRun::use_lamp))
                .and_then(step(!options_.mirrors.empty(), &CalibrationRun::use_mirrors))
                .and_then(step(tissue_gives_dispersion, &CalibrationRun::use_tissue)));
  judge_curves();
  HAL_CHECK(write());
  return verdict_;
}

} // namespace

hal::Result<> check(const CalibrateOptions& options) {
  const auto refuse = [](std::string_view words) {
    return hal::fail(ErrorCode::invalid_argument, std::string{words});
  };
  if (!options.mirrors.empty() && options.mirrors.size() != 2)
    return refuse(fmt::format("--mirror is given {} times, expected two mirrors at unequal depths",
                              options.mirrors.size()));
  const int curves =
      (options.mirrors.empty() ? 0 : 1) + (options.lamp ? 1 : 0) + (options.base ? 1 : 0);
  if (curves != 1)
    return refuse("expected one source of the k curve: two times --mirror, or --lamp with --lines, "
                  "or --calibration (with --tissue)");
  if (options.base && !options.tissue)
    return refuse("--calibration alone finds nothing new, expected --tissue with it");
  if (options.tissue && !options.tissue_shape && !pipeline::is_raw_recording(*options.tissue))
    return refuse("--tissue needs --shape B,A,N: B-scans, A-scans, samples");
  if (options.darks.sample.size() > 2)
    return refuse(fmt::format("--dark-sample is given {} times, expected once, or once for each "
                              "mirror",
                              options.darks.sample.size()));
  const bool parts = options.darks.none || options.darks.reference || !options.darks.sample.empty();
  if (!options.darks.plain.empty() && parts)
    return refuse("--dark does not go with --dark-none, --dark-reference and --dark-sample");
  if (options.spacing_um && options.mirror_distance_um)
    return refuse("--spacing-um does not go with --distance-um, which gives it");
  if (options.mirror_distance_um && options.mirrors.empty())
    return refuse("--distance-um is the distance of two mirrors, expected --mirror");
  if (options.refractive_index && !options.spacing_um && !options.mirror_distance_um)
    return refuse(
        "--refractive-index tells in what a depth spacing holds, expected --distance-um or "
        "--spacing-um with it");
  if (options.picture && options.picture->lexically_normal() == options.out.lexically_normal())
    return refuse(
        fmt::format("--out and --picture are both {}, expected two files", options.out.string()));
  return {};
}

hal::Result<CalibrationVerdict> calibrate(const CalibrateOptions& options) {
  return CalibrationRun{options}.run();
}

} // namespace octascope::firmware_host
