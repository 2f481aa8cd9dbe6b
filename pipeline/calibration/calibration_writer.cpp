#include "pipeline/calibration/calibration_writer.h"

#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "pipeline/files/atomic_file.h"
#include "pipeline/files/toml_text.h"

namespace octascope::pipeline {

namespace {

std::string curve_text(std::string_view meaning, const std::vector<double>& curve) {
  std::string text = fmt::format("# {}\n", meaning);
  for (const double value : curve)
    text += fmt::format("{:.17g}\n", value);
  return text;
}

std::string_view name_of(Interpolation interpolation) {
  switch (interpolation) {
  case Interpolation::linear: return "linear";
  case Interpolation::cubic: return "cubic";
  case Interpolation::sinc8: break;
  }
  return "sinc8";
}

std::string_view name_of(SpectralWindow window) {
  switch (window) {
  case SpectralWindow::hann: break;
  case SpectralWindow::hamming: return "hamming";
  case SpectralWindow::blackman: return "blackman";
  case SpectralWindow::gaussian: return "gaussian";
  case SpectralWindow::tukey: return "tukey";
  case SpectralWindow::flat: return "flat";
  }
  return "hann";
}

std::string_view name_of(BackgroundMode mode) {
  switch (mode) {
  case BackgroundMode::mean: break;
  case BackgroundMode::running: return "running";
  case BackgroundMode::file: return "file";
  case BackgroundMode::none: return "none";
  }
  return "mean";
}

// Little-endian floats, as the reader takes them.
std::string raw_floats(const std::vector<float>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float)};
}

// The sections on how lines become A-scans; what is not there has its default.
std::string options_toml(const Calibration& c, const std::string& background_name,
                         const std::string& source_name) {
  std::string text = fmt::format("[background]\nmode = \"{}\"\n", name_of(c.background_mode));
  if (!background_name.empty())
    text += fmt::format("file = {}\n", toml_text(background_name));
  if (c.fixed_pattern.mode == FixedPatternMode::minimum_variance)
    text += fmt::format("\n[fixed_pattern]\nmode = \"minimum_variance\"\nsegments = {}\n",
                        c.fixed_pattern.segments);
  if (c.shaping)
    text += fmt::format("\n[window]\nkind = \"shaped\"\nsource = {}\nfwhm = {}\n"
                        "highest_gain = {}\n",
                        toml_text(source_name), c.shaping->fwhm, c.shaping->highest_gain);
  else
    text += fmt::format("\n[window]\nkind = \"{}\"\n", name_of(c.window_kind));
  if (c.zero_padding != 1)
    text += fmt::format("\n[transform]\nzero_padding = {}\n", c.zero_padding);
  return text + "\n";
}

// Names of the files beside the TOML; empty where there is none.
struct CurveNames {
  std::string k_linear;
  std::string dispersion;
  std::string background;
  std::string source;
};

std::string toml(const FoundCalibration& found, const CurveNames& names) {
  const Calibration& c = found.calibration;
  std::string text = fmt::format("# Found by measurement; [provenance] says how.\n"
                                 "[spectrometer]\nsamples = {}\n",
                                 c.samples);
  if (!c.camera.empty())
    text += fmt::format("camera = {}\n", toml_text(c.camera));
  text += "\n[k_linear]\n";
  text += names.k_linear.empty()
              ? fmt::format("wavelength_polynomial_nm = {}\n",
                            toml_numbers(found.wavelength_polynomial_nm))
              : fmt::format("table = {}\ntable_gives = \"pixel\"\n", toml_text(names.k_linear));
  text += fmt::format("interpolation = \"{}\"\n\n", name_of(c.interpolation));
  if (!found.dispersion_polynomial_rad.empty())
    text += fmt::format("[dispersion]\npolynomial = {}\nsign = 1\n\n",
                        toml_numbers(found.dispersion_polynomial_rad));
  else if (!names.dispersion.empty())
    text += fmt::format("[dispersion]\ntable = {}\nsign = 1\n\n", toml_text(names.dispersion));
  text += options_toml(c, names.background, names.source);
  // What is assumed is no key, so that whoever reads the file knows it, too.
  const auto spacing = [](std::string_view key, double um, bool known,
                          std::string_view assumed = "assumed, not measured") {
    return known ? fmt::format("{} = {}\n", key, um)
                 : fmt::format("# {} = {} # {}\n", key, um, assumed);
  };
  // An index without the spacing that it belongs to would be refused.
  text += "[depth]\n" + spacing("spacing_um", c.depth_spacing_um,
                                found.spacing_known || c.refractive_index.has_value());
  if (c.refractive_index)
    text += fmt::format("refractive_index = {}\n", *c.refractive_index);
  // A run's [scan] goes before these two.
  constexpr std::string_view scanners = "assumed, unless [scan] of a configuration says it";
  text += spacing("a_spacing_um", c.a_spacing_um, !c.assumed_spacings.a_scans, scanners) +
          spacing("b_spacing_um", c.b_spacing_um, !c.assumed_spacings.b_scans, scanners) + "\n";
  const Provenance& p = found.provenance;
  return text + fmt::format("[provenance]\nprogram = {}\nmethod = {}\ninputs = {}\ncreated = {}\n"
                            "verdict = {}\n",
                            toml_text(p.program), toml_text(p.method), toml_text(p.inputs),
                            toml_text(p.created), toml_text(p.verdict));
}

constexpr std::string_view k_linear_ending = "_k_linear.txt";
constexpr std::string_view dispersion_ending = "_dispersion_rad.txt";
constexpr std::string_view background_ending = "_background_f32.raw";
constexpr std::string_view source_ending = "_source_f32.raw";

std::filesystem::path beside(const std::filesystem::path& file, std::string_view ending) {
  return file.parent_path() / (file.stem().string() + std::string{ending});
}

struct Output {
  std::filesystem::path file;
  std::string text;
};

} // namespace

std::vector<std::filesystem::path> curves_beside(const std::filesystem::path& file) {
  return {beside(file, k_linear_ending), beside(file, dispersion_ending),
          beside(file, background_ending), beside(file, source_ending)};
}

hal::Result<> write_calibration(const FoundCalibration& found, const std::filesystem::path& file) {
  const Calibration& calibration = found.calibration;
  std::vector<Output> outputs;
  const auto write_beside = [&](std::string_view ending, std::string text) {
    outputs.push_back({beside(file, ending), std::move(text)});
    return outputs.back().file.filename().string();
  };
  CurveNames names;
  if (found.wavelength_polynomial_nm.empty())
    names.k_linear =
        write_beside(k_linear_ending, curve_text("fractional pixel positions uniform in wavenumber",
                                                 calibration.positions));
  if (found.dispersion_polynomial_rad.empty() && !calibration.dispersion_rad.empty())
    names.dispersion =
        write_beside(dispersion_ending,
                     curve_text("phase in rad over the k-linear samples, multiplies as exp(+i)",
                                calibration.dispersion_rad));
  if (calibration.background_mode == BackgroundMode::file)
    names.background = write_beside(background_ending, raw_floats(calibration.background));
  if (calibration.shaping)
    names.source = write_beside(source_ending, raw_floats(calibration.shaping->source));
  outputs.push_back({file, toml(found, names)});
  for (std::size_t i = 0; i + 1 < outputs.size(); ++i) {
    if (outputs[i].file.lexically_normal() == file.lexically_normal())
      return hal::fail(
          hal::ErrorCode::invalid_argument,
          "{}: a curve file would have the same name, expected a name that ends in .toml",
          file.string());
  }

  std::vector<AtomicFile> files;
  for (const Output& output : outputs) {
    HAL_TRY(auto made, AtomicFile::create(output.file));
    HAL_CHECK(made.write_at(0, std::as_bytes(std::span{output.text})));
    files.push_back(std::move(made));
  }
  for (AtomicFile& made : files) {
    HAL_CHECK(made.commit());
  }
  return {};
}

} // namespace octascope::pipeline
