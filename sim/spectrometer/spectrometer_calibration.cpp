#include "sim/spectrometer/spectrometer_calibration.h"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <string>

#include <fmt/format.h>

namespace octascope::sim {
namespace {

hal::Result<> write_text(const std::filesystem::path& file, const std::string& text) {
  errno = 0;
  std::ofstream out(file, std::ios::binary | std::ios::trunc);
  out << text;
  out.close();
  if (!out)
    return hal::fail(hal::ErrorCode::system,
                     fmt::format("{}: cannot be written ({}); expected a folder that exists and "
                                 "may be written to",
                                 file.string(), std::strerror(errno)));
  return {};
}

std::string curve_text(const std::vector<double>& curve) {
  std::string text;
  for (const double value : curve)
    text += fmt::format("{:.12g}\n", value);
  return text;
}

} // namespace

hal::Result<> write_calibration(const Spectrometer& spectrometer, const pipeline::ScanPlan& plan,
                                const std::filesystem::path& file) {
  const std::string k_name = file.stem().string() + "_k_linear.txt";
  const std::string dispersion_name = file.stem().string() + "_dispersion_rad.txt";
  const std::string medium = plan.refractive_index
                                 ? fmt::format("refractive_index = {}\n", *plan.refractive_index)
                                 : std::string{};
  const std::string toml =
      fmt::format("# The curves that went into the simulated spectrometer.\n"
                  "[spectrometer]\n"
                  "samples = {}\n\n"
                  "[k_linear]\n"
                  "table = \"{}\"\n"
                  "interpolation = \"sinc8\"\n\n"
                  "[dispersion]\n"
                  "table = \"{}\"\n"
                  "sign = 1\n\n"
                  "[background]\n"
                  "mode = \"mean\"\n\n"
                  "[window]\n"
                  "kind = \"hann\"\n\n"
                  "[depth]\n"
                  "spacing_um = {}\n{}"
                  "a_spacing_um = {}\n"
                  "b_spacing_um = {}\n",
                  spectrometer.samples(), k_name, dispersion_name, plan.depth_spacing_um, medium,
                  plan.a_spacing_um, plan.b_spacing_um);
  HAL_CHECK(write_text(file.parent_path() / k_name, curve_text(spectrometer.true_k_positions())));
  HAL_CHECK(write_text(file.parent_path() / dispersion_name,
                       curve_text(spectrometer.true_dispersion_rad())));
  return write_text(file, toml);
}

} // namespace octascope::sim
