#include "pipeline/calibration_writer.h"

#include <algorithm>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "pipeline/atomic_file.h"

namespace octascope::pipeline {

namespace {

std::string curve_text(std::string_view meaning, const std::vector<double>& curve) {
  std::string text = fmt::format("# {}\n", meaning);
  for (const double value : curve)
    text += fmt::format("{:.17g}\n", value);
  return text;
}

// A TOML basic string: quotes, backslashes and control characters are escaped.
std::string toml_text(std::string_view text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\')
      result += fmt::format("\\{}", c);
    else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f)
      result += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
    else
      result += c;
  }
  return result + "\"";
}

std::string numbers(const std::vector<double>& values) {
  std::vector<std::string> texts;
  for (const double value : values) {
    std::string text = fmt::format("{:.17g}", value);
    if (text.find_first_of(".e") == std::string::npos)
      text += ".0";
    texts.push_back(std::move(text));
  }
  return fmt::format("[{}]", fmt::join(texts, ", "));
}

std::string_view name_of(Interpolation interpolation) {
  switch (interpolation) {
  case Interpolation::linear: return "linear";
  case Interpolation::cubic: return "cubic";
  case Interpolation::sinc8: break;
  }
  return "sinc8";
}

std::string toml(const FoundCalibration& found, const std::string& k_name,
                 const std::string& dispersion_name) {
  const Calibration& c = found.calibration;
  std::string text = fmt::format("# Found by measurement; [provenance] says how.\n"
                                 "[spectrometer]\nsamples = {}\n\n[k_linear]\n",
                                 c.samples);
  text += k_name.empty() ? fmt::format("wavelength_polynomial_nm = {}\n",
                                       numbers(found.wavelength_polynomial_nm))
                         : fmt::format("table = {}\n", toml_text(k_name));
  text += fmt::format("interpolation = \"{}\"\n\n", name_of(c.interpolation));
  if (!found.dispersion_polynomial_rad.empty())
    text += fmt::format("[dispersion]\npolynomial = {}\nsign = 1\n\n",
                        numbers(found.dispersion_polynomial_rad));
  else if (!dispersion_name.empty())
    text += fmt::format("[dispersion]\ntable = {}\nsign = 1\n\n", toml_text(dispersion_name));
  text += "[background]\nmode = \"mean\"\n\n[window]\nkind = \"hann\"\n\n";
  text += fmt::format("[depth]{}\nspacing_um = {}\na_spacing_um = {}\nb_spacing_um = {}\n\n",
                      found.spacing_known ? "" : " # not measured: assumed", c.depth_spacing_um,
                      c.a_spacing_um, c.b_spacing_um);
  const Provenance& p = found.provenance;
  return text + fmt::format("[provenance]\nprogram = {}\nmethod = {}\ninputs = {}\ncreated = {}\n"
                            "verdict = {}\n",
                            toml_text(p.program), toml_text(p.method), toml_text(p.inputs),
                            toml_text(p.created), toml_text(p.verdict));
}

struct Output {
  std::filesystem::path file;
  std::string text;
};

} // namespace

hal::Result<> write_calibration(const FoundCalibration& found, const std::filesystem::path& file) {
  const std::string stem = file.stem().string();
  std::vector<Output> outputs;
  std::string k_name;
  std::string dispersion_name;
  if (found.wavelength_polynomial_nm.empty()) {
    k_name = stem + "_k_linear.txt";
    outputs.push_back(
        {file.parent_path() / k_name, curve_text("fractional pixel positions uniform in wavenumber",
                                                 found.calibration.positions)});
  }
  if (found.dispersion_polynomial_rad.empty() && !found.calibration.dispersion_rad.empty()) {
    dispersion_name = stem + "_dispersion_rad.txt";
    outputs.push_back({file.parent_path() / dispersion_name,
                       curve_text("phase in rad over the k-linear samples, multiplies as exp(+i)",
                                  found.calibration.dispersion_rad)});
  }
  outputs.push_back({file, toml(found, k_name, dispersion_name)});
  for (std::size_t i = 0; i + 1 < outputs.size(); ++i) {
    if (outputs[i].file.lexically_normal() == file.lexically_normal())
      return hal::fail(hal::Fault::invalid_argument,
                       fmt::format("{}: a curve file would have the same name, expected a name "
                                   "that ends in .toml",
                                   file.string()));
  }

  std::vector<AtomicFile> files;
  for (const Output& output : outputs) {
    auto made = AtomicFile::create(output.file);
    if (!made)
      return tl::make_unexpected(made.error());
    if (auto written = made->write_at(0, std::as_bytes(std::span{output.text})); !written)
      return written;
    files.push_back(std::move(*made));
  }
  for (AtomicFile& made : files) {
    if (auto committed = made.commit(); !committed)
      return committed;
  }
  return {};
}

} // namespace octascope::pipeline
