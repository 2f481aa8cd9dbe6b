#include "firmware-host/commands/calibrate/calibrate_verdict.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace octascope::firmware_host {

namespace {

std::string in_um(double bins, const std::optional<double>& spacing_um) {
  return spacing_um ? fmt::format(" ({:.2f} um)", bins * *spacing_um) : "";
}

std::string mirrors_text(const CalibrationVerdict& v) {
  std::string text;
  for (const MirrorVerdict& m : v.mirrors)
    text += fmt::format(
        "mirror at {:.2f} bins{}: FWHM {:.2f} -> {:.2f} bins{}, peak {:.1f} -> {:.1f} dB, residual "
        "phase {:.3f} rad, pixels {} to {}  [{}]\n",
        m.depth_bins, in_um(m.depth_bins, v.spacing_um), m.fwhm_before_bins, m.fwhm_after_bins,
        in_um(m.fwhm_after_bins, v.spacing_um), m.level_before_db, m.level_after_db, m.residual_rad,
        m.first_bright_pixel, m.last_bright_pixel, m.file);
  if (v.mirrors.empty())
    return text;
  text += v.spacing_um
              ? fmt::format("roll-off {:.2f} dB/mm", v.roll_off_db_per_bin() / *v.spacing_um * 1000)
              : fmt::format("roll-off {:.2f} dB/100 bins", 100 * v.roll_off_db_per_bin());
  return text + fmt::format(", depth linear within {:.3f} bins, residual phase {:.3f} rad rms\n"
                            "samples lie on the side of {} ({})\n",
                            v.depth_error_bins(), v.residual_rad(), v.sample_side, v.side_source);
}

nlohmann::json mirrors_json(const CalibrationVerdict& v) {
  auto mirrors = nlohmann::json::array();
  for (const MirrorVerdict& m : v.mirrors) {
    nlohmann::json mirror{{"file", m.file},
                          {"depth_bins", m.depth_bins},
                          {"peak_bins", m.peak_bins},
                          {"fwhm_before_bins", m.fwhm_before_bins},
                          {"fwhm_after_bins", m.fwhm_after_bins},
                          {"level_before_db", m.level_before_db},
                          {"level_after_db", m.level_after_db},
                          {"residual_phase_rad", m.residual_rad},
                          {"bright_pixels", {m.first_bright_pixel, m.last_bright_pixel}}};
    if (v.spacing_um) {
      mirror["fwhm_before_um"] = m.fwhm_before_bins * *v.spacing_um;
      mirror["fwhm_after_um"] = m.fwhm_after_bins * *v.spacing_um;
    }
    mirrors.push_back(std::move(mirror));
  }
  return mirrors;
}

// In what the lengths above hold.
std::string medium_text(const CalibrationVerdict& v) {
  if (!v.spacing_um)
    return {};
  return v.refractive_index
             ? fmt::format("{:.4f} um a bin, for a refractive index of {:.4g}\n", *v.spacing_um,
                           *v.refractive_index)
             : fmt::format("{:.4f} um a bin, for a medium that nobody said: --refractive-index\n",
                           *v.spacing_um);
}

} // namespace

double CalibrationVerdict::residual_rad() const {
  double squares = 0;
  for (const MirrorVerdict& m : mirrors)
    squares += m.residual_rad * m.residual_rad;
  return mirrors.empty() ? 0 : std::sqrt(squares / static_cast<double>(mirrors.size()));
}

double CalibrationVerdict::depth_error_bins() const {
  double greatest = 0;
  for (const MirrorVerdict& m : mirrors)
    greatest = std::max(greatest, std::abs(m.peak_bins - m.depth_bins));
  return greatest;
}

double CalibrationVerdict::roll_off_db_per_bin() const {
  if (mirrors.size() != 2)
    return 0;
  return (mirrors[0].level_after_db - mirrors[1].level_after_db) /
         (mirrors[1].depth_bins - mirrors[0].depth_bins);
}

std::string summary(const CalibrationVerdict& v) {
  if (!v.mirrors.empty())
    return fmt::format("FWHM {:.2f} and {:.2f} bins, residual phase {:.3f} rad rms",
                       v.mirrors[0].fwhm_after_bins, v.mirrors[1].fwhm_after_bins,
                       v.residual_rad());
  std::string text;
  if (v.lamp)
    text += fmt::format("lines within {:.4g} nm rms", v.lamp->rms_nm);
  if (v.tissue)
    text += fmt::format("{}sharpness {:.4g} -> {:.4g}", v.lamp ? ", " : "",
                        v.tissue->sharpness_before, v.tissue->sharpness_after);
  return text;
}

std::string to_text(const CalibrationVerdict& v) {
  std::string text = fmt::format("{}: {}, {} samples\n", v.file, v.method, v.samples);
  text += mirrors_text(v) + medium_text(v);
  if (v.lamp) {
    for (std::size_t i = 0; i < v.lamp->pixels.size(); ++i)
      text += fmt::format("line {:.3f} nm at pixel {:.3f}, residual {:+.4f} nm\n",
                          v.lamp->lines_nm[i], v.lamp->pixels[i], v.lamp->residuals_nm[i]);
    text += fmt::format("lines within {:.4f} nm rms\n", v.lamp->rms_nm);
  }
  if (v.tissue)
    text += fmt::format("tissue sharpness {:.6g} -> {:.6g} ({:+.1f} %) with the dispersion\n",
                        v.tissue->sharpness_before, v.tissue->sharpness_after,
                        100 * (v.tissue->sharpness_after / v.tissue->sharpness_before - 1));
  if (v.table)
    text +=
        fmt::format("table gives {}s ({}): tissue sharpness {:.6g}, the other way round {:.6g}\n{}",
                    v.table->gives, v.table->source, v.table->sharpness, v.table->other_sharpness,
                    v.table->warning.empty() ? "" : "warning: " + v.table->warning + "\n");
  return text +
         fmt::format("k curve monotone, steps {:.4f} to {:.4f} pixels; dispersion {:.3f} rad "
                     "rms\n",
                     v.least_step_pixels, v.greatest_step_pixels, v.dispersion_rms_rad);
}

std::string to_json(const CalibrationVerdict& v) {
  nlohmann::json json{{"method", v.method},
                      {"out", v.file},
                      {"samples", v.samples},
                      {"monotone", v.monotone},
                      {"least_step_pixels", v.least_step_pixels},
                      {"greatest_step_pixels", v.greatest_step_pixels},
                      {"dispersion_rms_rad", v.dispersion_rms_rad}};
  if (v.spacing_um)
    json["spacing_um"] = *v.spacing_um;
  if (v.refractive_index)
    json["refractive_index"] = *v.refractive_index;
  if (!v.mirrors.empty()) {
    json["mirrors"] = mirrors_json(v);
    json["sample_side"] = v.sample_side;
    json["side_source"] = v.side_source;
    json["residual_phase_rad"] = v.residual_rad();
    json["depth_error_bins"] = v.depth_error_bins();
    json["roll_off_db_per_bin"] = v.roll_off_db_per_bin();
    if (v.spacing_um)
      json["roll_off_db_per_mm"] = v.roll_off_db_per_bin() / *v.spacing_um * 1000;
  }
  if (v.lamp)
    json["lamp"] = {{"lines_nm", v.lamp->lines_nm},
                    {"pixels", v.lamp->pixels},
                    {"residuals_nm", v.lamp->residuals_nm},
                    {"wavelength_polynomial_nm", v.lamp->polynomial_nm},
                    {"rms_nm", v.lamp->rms_nm}};
  if (v.tissue) {
    json["tissue"] = {{"sharpness_before", v.tissue->sharpness_before},
                      {"sharpness_after", v.tissue->sharpness_after}};
    if (!v.tissue->polynomial_rad.empty())
      json["tissue"]["dispersion_polynomial_rad"] = v.tissue->polynomial_rad;
  }
  if (v.table)
    json["table"] = {{"gives", v.table->gives},
                     {"source", v.table->source},
                     {"sharpness", v.table->sharpness},
                     {"other_sharpness", v.table->other_sharpness},
                     {"warning", v.table->warning}};
  // A file's name need not be UTF-8.
  return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

} // namespace octascope::firmware_host
