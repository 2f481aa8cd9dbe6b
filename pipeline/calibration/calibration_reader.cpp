#include <algorithm>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "pipeline/calibration/calibration.h"
#include "pipeline/files/config_document.h"
#include "pipeline/files/file_name.h"
#include "pipeline/files/text_curve.h"

namespace octascope::pipeline {

namespace fs = std::filesystem;
using hal::ErrorCode;

namespace {

// Far beyond any spectrometer, and small enough that arithmetic stays finite.
constexpr NumberRange spacing_range_um{1e-3, 1e6};

// Reads the sections one by one. A complaint about the document itself sticks to the document; an
// error in a file that it names is kept here. The first of either is what load() returns.
class CalibrationReader {
public:
  CalibrationReader(ConfigDocument& document, fs::path file)
      : document_(document), root_(document.root()), file_(std::move(file)) {}

  hal::Result<Calibration> read(int expected_samples);

private:
  bool read_samples(int expected_samples);
  void read_k_linear();
  void read_dispersion();
  void read_background();
  void read_fixed_pattern();
  void read_window();
  void read_shaping(ConfigTable window);
  void read_transform();
  void read_depth();
  void read_provenance();
  std::vector<double> read_curve(const fs::path& path);
  std::vector<float> read_spectrum(const fs::path& path);
  void check_positions(const std::string& source, bool measured);
  void read_wavenumbers(const std::string& source);
  void keep(hal::Error error) {
    if (!error_)
      error_ = std::move(error);
  }

  ConfigDocument& document_;
  ConfigTable root_;
  fs::path file_;
  Calibration calibration_;
  std::optional<hal::Error> error_;
};

hal::Result<Calibration> CalibrationReader::read(int expected_samples) {
  if (read_samples(expected_samples)) {
    read_k_linear();
    read_dispersion();
    read_background();
    read_fixed_pattern();
    read_window();
    read_transform();
    read_depth();
    read_provenance();
    // A misspelt key explains more than what follows from it, so the document speaks first.
    HAL_CHECK(document_.finish());
  }
  if (error_)
    return tl::make_unexpected(*error_);
  if (const auto valid = calibration_.validate(); !valid)
    return hal::fail(valid.error().code, "{}: {}", file_.string(), valid.error().message);
  return calibration_;
}

// Without an agreed number of samples nothing else can be judged.
bool CalibrationReader::read_samples(int expected_samples) {
  ConfigTable spectrometer = root_.table("spectrometer");
  calibration_.camera = spectrometer.text("camera", "");
  if (!spectrometer.has("samples")) {
    keep({ErrorCode::invalid_argument,
          fmt::format("{}: [spectrometer] samples is missing, expected samples = {}",
                      file_.string(), expected_samples)});
    return false;
  }
  const int samples = spectrometer.integer("samples", expected_samples,
                                           {double{fewest_samples}, double{most_samples}});
  if (samples != expected_samples) {
    keep({ErrorCode::invalid_argument,
          fmt::format("{}: [spectrometer] samples is {}, but the spectra have {} samples a line",
                      file_.string(), samples, expected_samples)});
    return false;
  }
  calibration_.samples = samples;
  return true;
}

std::vector<double> CalibrationReader::read_curve(const fs::path& path) {
  auto curve = read_text_curve(path, static_cast<std::size_t>(calibration_.samples));
  if (curve)
    return std::move(*curve);
  keep(curve.error());
  return {};
}

// Counts by pixel: text when the name says so, else 32-bit floats.
std::vector<float> CalibrationReader::read_spectrum(const fs::path& path) {
  if (const std::string ending = file_ending(path); ending == ".txt" || ending == ".csv") {
    const std::vector<double> counts = read_curve(path);
    return {counts.begin(), counts.end()};
  }
  auto counts = read_float_curve(path, static_cast<std::size_t>(calibration_.samples));
  if (counts)
    return std::move(*counts);
  keep(counts.error());
  return {};
}

void CalibrationReader::read_k_linear() {
  ConfigTable k_linear = root_.table("k_linear");
  const auto interpolation =
      k_linear.choice("interpolation", static_cast<std::size_t>(Interpolation::sinc8),
                      {"linear", "cubic", "sinc8"});
  calibration_.interpolation = static_cast<Interpolation>(interpolation);

  const auto table = k_linear.path("table");
  const bool wavenumbers = k_linear.choice("table_gives", 0, {"pixel", "wavenumber"}) == 1;
  if (k_linear.has("table_gives") && !table)
    k_linear.complain("table_gives is given, but no table that it belongs to");
  const auto polynomial = k_linear.numbers("polynomial");
  const auto wavelength = k_linear.numbers("wavelength_polynomial_nm");
  const int forms =
      k_linear.has("table") + k_linear.has("polynomial") + k_linear.has("wavelength_polynomial_nm");
  if (forms != 1) {
    keep({ErrorCode::invalid_argument,
          fmt::format("{}: [k_linear] has {} of table, polynomial and wavelength_polynomial_nm, "
                      "expected exactly one (polynomial = [0.0, {}.0] for spectra that are uniform "
                      "in k already)",
                      file_.string(), forms, calibration_.samples - 1)});
    return;
  }
  if (table) {
    calibration_.positions = read_curve(*table);
    calibration_.k_table = wavenumbers                   ? KTable::wavenumber
                           : k_linear.has("table_gives") ? KTable::pixel
                                                         : KTable::unsaid;
    if (wavenumbers)
      read_wavenumbers(table->string());
    else
      check_positions(table->string(), true);
  } else if (!polynomial.empty()) {
    calibration_.positions = evaluate_unit_polynomial(polynomial, calibration_.samples);
    check_positions(file_.string() + ": [k_linear] polynomial", false);
  } else if (!wavelength.empty()) {
    auto positions = positions_from_wavelength(wavelength, calibration_.samples);
    if (positions)
      calibration_.positions = std::move(*positions);
    else
      keep({positions.error().code, fmt::format("{}: [k_linear] wavelength_polynomial_nm: {}",
                                                file_.string(), positions.error().message)});
  } else {
    keep({ErrorCode::invalid_argument,
          fmt::format("{}: [k_linear] has an empty form, expected a file name or at least one "
                      "coefficient",
                      file_.string())});
  }
}

void CalibrationReader::check_positions(const std::string& source, bool measured) {
  if (calibration_.positions.empty())
    return;
  auto fault = find_position_fault(calibration_.positions);
  if (!fault && measured)
    fault = find_position_jump(calibration_.positions);
  if (fault)
    keep({ErrorCode::bad_data, fmt::format("{}: {}", source, *fault)});
  for (double& position : calibration_.positions)
    position = std::clamp(position, 0.0, static_cast<double>(calibration_.samples - 1));
}

// The table's values, in whatever unit, become positions. They are judged as positions are, once
// they span as many steps as there are pixels.
void CalibrationReader::read_wavenumbers(const std::string& source) {
  std::vector<double> curve = std::exchange(calibration_.positions, {});
  if (curve.empty())
    return;
  for (std::size_t p = 1; p < curve.size(); ++p) {
    if (curve.back() > curve.front() ? curve[p] > curve[p - 1] : curve[p] < curve[p - 1])
      continue;
    return keep({ErrorCode::bad_data,
                 fmt::format("{}: wavenumbers are not monotone: pixel {} has {}, pixel {} has {}",
                             source, p - 1, curve[p - 1], p, curve[p])});
  }
  const double first = curve.front();
  const double step = (curve.back() - first) / static_cast<double>(curve.size() - 1);
  for (double& k : curve)
    k = (k - first) / step;
  if (const auto jump = find_position_jump(curve))
    return keep({ErrorCode::bad_data,
                 fmt::format("{}: of the wavenumbers, in mean steps: {}", source, *jump)});
  calibration_.positions = invert_curve(curve);
}

void CalibrationReader::read_dispersion() {
  if (!root_.has("dispersion")) {
    root_.table("dispersion");
    return;
  }
  ConfigTable dispersion = root_.table("dispersion");
  const auto table = dispersion.path("table");
  const auto polynomial = dispersion.numbers("polynomial");
  const int sign = dispersion.integer("sign", 1, {-1, 1});
  if (sign == 0)
    dispersion.complain("sign is 0, expected 1 or -1");
  if (dispersion.has("table") == dispersion.has("polynomial")) {
    dispersion.complain(dispersion.has("table")
                            ? "has both table and polynomial, expected exactly one"
                            : "has neither table nor polynomial, expected exactly one");
    return;
  }
  if (table)
    calibration_.dispersion_rad = read_curve(*table);
  else if (!polynomial.empty())
    calibration_.dispersion_rad = evaluate_unit_polynomial(polynomial, calibration_.samples);
  else
    dispersion.complain("has an empty form, expected a file name or at least one coefficient");
  for (double& phase : calibration_.dispersion_rad)
    phase *= sign;
}

void CalibrationReader::read_background() {
  ConfigTable background = root_.table("background");
  calibration_.background_mode = static_cast<BackgroundMode>(
      background.choice("mode", static_cast<std::size_t>(BackgroundMode::running),
                        {"mean", "running", "file", "none"}));
  const auto file = background.path("file");
  const bool wanted = calibration_.background_mode == BackgroundMode::file;
  if (wanted != background.has("file")) {
    background.complain(wanted ? "mode is \"file\", but there is no file = \"…\""
                               : "file is given, but mode is not \"file\"");
    return;
  }
  if (!file) {
    if (wanted)
      background.complain("file is empty, expected a file name");
    return;
  }
  calibration_.background = read_spectrum(*file);
}

void CalibrationReader::read_fixed_pattern() {
  ConfigTable table = root_.table("fixed_pattern");
  FixedPatternRemoval& removal = calibration_.fixed_pattern;
  removal.mode = static_cast<FixedPatternMode>(table.choice(
      "mode", static_cast<std::size_t>(FixedPatternMode::none), {"none", "minimum_variance"}));
  if (table.has("segments") && removal.mode == FixedPatternMode::none)
    table.complain("segments is given, but mode is not \"minimum_variance\"");
  removal.segments = table.integer(
      "segments", removal.segments,
      {double{FixedPatternRemoval::fewest_segments}, double{FixedPatternRemoval::most_segments}});
}

void CalibrationReader::read_window() {
  ConfigTable window = root_.table("window");
  constexpr std::size_t shaped = 6; // after the SpectralWindows
  const auto kind =
      window.choice("kind", static_cast<std::size_t>(SpectralWindow::hann),
                    {"hann", "hamming", "blackman", "gaussian", "tukey", "flat", "shaped"});
  for (const std::string_view key : {"source", "dark", "fwhm", "highest_gain"}) {
    if (window.has(key) && kind != shaped)
      window.complain("{} is given, but kind is not \"shaped\"", key);
  }
  read_shaping(window);
  if (kind == shaped)
    return;
  calibration_.window_kind = static_cast<SpectralWindow>(kind);
  calibration_.window = make_spectral_window(calibration_.window_kind, calibration_.samples);
}

void CalibrationReader::read_shaping(ConfigTable window) {
  SourceShaping shaping;
  const auto source = window.path("source");
  const auto dark = window.path("dark");
  shaping.fwhm = window.number("fwhm", shaping.fwhm,
                               {SourceShaping::narrowest_fwhm, SourceShaping::widest_fwhm});
  shaping.highest_gain =
      window.number("highest_gain", shaping.highest_gain, {1, SourceShaping::most_gain});
  if (window.text("kind", "") != "shaped")
    return;
  if (!source || (window.has("dark") && !dark)) {
    window.complain(!source ? "kind is \"shaped\", but there is no source = \"…\", a recorded "
                              "spectrum of the light source"
                            : "dark is empty, expected a file name");
    return;
  }
  shaping.source = read_spectrum(*source);
  if (dark) {
    const std::vector<float> counts = read_spectrum(*dark);
    for (std::size_t p = 0; p < std::min(counts.size(), shaping.source.size()); ++p)
      shaping.source[p] -= counts[p];
  }
  if (error_ || calibration_.positions.empty())
    return;
  auto factors = make_shaping_factors(shaping, calibration_.positions, calibration_.interpolation);
  if (!factors) {
    keep({factors.error().code, fmt::format("{}: {}", source->string(), factors.error().message)});
    return;
  }
  calibration_.window = std::move(*factors);
  calibration_.shaping = std::move(shaping);
}

void CalibrationReader::read_transform() {
  calibration_.zero_padding =
      root_.table("transform").integer("zero_padding", calibration_.zero_padding, {1, 2});
}

void CalibrationReader::read_depth() {
  ConfigTable depth = root_.table("depth");
  calibration_.depth_spacing_um =
      depth.number("spacing_um", calibration_.depth_spacing_um, spacing_range_um);
  if (depth.has("refractive_index"))
    calibration_.refractive_index = depth.number("refractive_index", least_refractive_index,
                                                 {least_refractive_index, most_refractive_index});
  if (depth.has("refractive_index") && !depth.has("spacing_um"))
    depth.complain("refractive_index is given, but no spacing_um that it belongs to");
  calibration_.a_spacing_um =
      depth.number("a_spacing_um", calibration_.a_spacing_um, spacing_range_um);
  calibration_.b_spacing_um =
      depth.number("b_spacing_um", calibration_.b_spacing_um, spacing_range_um);
  calibration_.assumed_spacings = {!depth.has("spacing_um"), !depth.has("a_spacing_um"),
                                   !depth.has("b_spacing_um")};
}

// For people only; a calibration that the program found has it.
void CalibrationReader::read_provenance() {
  ConfigTable provenance = root_.table("provenance");
  for (const std::string_view key : {"program", "method", "inputs", "created", "verdict"})
    provenance.text(key, "");
}

} // namespace

hal::Result<Calibration> Calibration::load(const fs::path& file, int expected_samples) {
  HAL_TRY(auto document, ConfigDocument::load(file));
  return CalibrationReader{document, file}.read(expected_samples);
}

hal::Result<std::string> calibration_camera(const fs::path& file) {
  return ConfigDocument::load(file).map([](const ConfigDocument& document) {
    return document.root().table("spectrometer").text("camera", "");
  });
}

hal::Result<ConfigDocument> calibration_document(const fs::path& file) {
  auto document = ConfigDocument::load(file);
  if (!document)
    return document;
  ConfigTable root = document->root();
  root.table("k_linear").path("table");
  root.table("dispersion").path("table");
  root.table("background").path("file");
  ConfigTable window = root.table("window");
  window.path("source");
  window.path("dark");
  return document;
}

} // namespace octascope::pipeline
