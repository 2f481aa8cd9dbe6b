#include "firmware-host/commands/calibrate/calibrate_picture.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "firmware-host/commands/line_plot.h"

namespace octascope::firmware_host {

namespace {

constexpr std::array<Colour, 2> strong{Colour{0, 90, 180}, Colour{200, 60, 0}};
constexpr std::array<Colour, 2> pale{Colour{150, 190, 230}, Colour{245, 190, 150}};
constexpr int width = 1200;
constexpr int panel_height = 260;

pipeline::Image blank(int panels) {
  pipeline::Image image{width, panels * panel_height, 3};
  std::ranges::fill(image.pixels, std::uint8_t{255});
  return image;
}

void draw(pipeline::Image& image, int row, PlotPanel& panel) {
  draw_panel(image, {0, row * panel_height, width, panel_height}, panel);
}

// Fits all finite values of the curves, with some room.
void fit_y(PlotPanel& panel) {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const PlotCurve& curve : panel.curves) {
    for (const double value : curve.values) {
      if (std::isfinite(value)) {
        low = std::min(low, value);
        high = std::max(high, value);
      }
    }
  }
  if (!(low < high)) {
    low = std::isfinite(low) ? low - 1 : -1;
    high = low + 2;
  }
  const double room = 0.06 * (high - low);
  panel.y_low = low - room;
  panel.y_high = high + room;
}

std::vector<double> relative_db(const pipeline::AxialPsf& psf, double highest_db) {
  std::vector<double> db(psf.magnitude.size());
  std::transform(psf.magnitude.begin(), psf.magnitude.end(), db.begin(), [&](double magnitude) {
    return 20 * std::log10(std::max(magnitude, 1e-30)) - highest_db;
  });
  return db;
}

std::vector<double> bow_of(std::span<const double> positions) {
  std::vector<double> bow(positions.size());
  const double slope =
      (positions.back() - positions.front()) / static_cast<double>(positions.size() - 1);
  for (std::size_t m = 0; m < bow.size(); ++m)
    bow[m] = positions[m] - positions.front() - slope * static_cast<double>(m);
  return bow;
}

PlotPanel curve_panel(std::string title, std::vector<double> values) {
  PlotPanel panel;
  panel.title = std::move(title);
  panel.x_last = static_cast<double>(values.size() - 1);
  panel.curves.push_back({std::move(values), strong[0], ""});
  fit_y(panel);
  return panel;
}

// What the measured phase of a mirror is off the straight line that its depth is, over k.
std::vector<double> measured_rest(const pipeline::MirrorPair& pair, std::size_t i) {
  const pipeline::Fringe& fringe = pair.fringes[i];
  std::vector<double> rest(pair.positions.size(), std::numeric_limits<double>::quiet_NaN());
  for (std::size_t m = 0; m < rest.size(); ++m) {
    const double r = pair.positions[m];
    const auto p = static_cast<std::size_t>(r);
    if (p < fringe.first_bright || p + 1 > fringe.last_bright)
      continue;
    const double f = r - static_cast<double>(p);
    const double measured =
        fringe.measured_rad[p] + f * (fringe.measured_rad[p + 1] - fringe.measured_rad[p]);
    // The smooth phase is −θ·sign apart from the line.
    rest[m] = measured - fringe.phase_rad.at(r) - pair.theta_sign[i] * pair.dispersion_rad[m];
  }
  return rest;
}

} // namespace

pipeline::Image draw_mirrors(const std::array<MirrorMeasurement, 2>& mirrors,
                             const pipeline::MirrorPair& pair) {
  pipeline::Image image = blank(4);
  const auto last = static_cast<double>(pair.positions.size() - 1);
  PlotPanel spectra{"INTERFERENCE (COUNTS) OVER PIXEL", {}, 1, last, 0, 1};
  PlotPanel phases{"PHASE LEFT BY A STRAIGHT LINE (RAD) OVER K SAMPLE", {}, 1, last, 0, 1};
  PlotPanel psfs{
      "POINT SPREAD (DB) OVER DEPTH BIN", {}, 1.0 / pipeline::psf_steps_per_bin, 1, -60, 3};
  double highest_db = -1e9;
  for (const MirrorMeasurement& mirror : mirrors)
    highest_db = std::max(highest_db, mirror.after.level_db);
  for (std::size_t i = 0; i < 2; ++i) {
    const std::string name = i == 0 ? "FIRST MIRROR" : "SECOND MIRROR";
    spectra.curves.push_back({mirrors[i].interferogram, strong[i], name});
    phases.curves.push_back({measured_rest(pair, i), strong[i], name});
    psfs.curves.push_back({relative_db(mirrors[i].before, highest_db), pale[i], "BEFORE"});
    psfs.curves.push_back({relative_db(mirrors[i].after, highest_db), strong[i], "AFTER"});
    psfs.x_last = std::max(psfs.x_last, 1.6 * pair.depth_bins[i]);
  }
  std::vector<double> minus_theta(pair.dispersion_rad.size());
  std::transform(pair.dispersion_rad.begin(), pair.dispersion_rad.end(), minus_theta.begin(),
                 std::negate<>{});
  phases.curves.push_back({std::move(minus_theta), {0, 0, 0}, "MINUS DISPERSION"});
  psfs.x_last = std::min(psfs.x_last, (last + 1) / 2);
  fit_y(spectra);
  fit_y(phases);
  PlotPanel bow = curve_panel("K POSITION LESS ITS STRAIGHT LINE (PIXELS) OVER K SAMPLE",
                              bow_of(pair.positions));
  draw(image, 0, spectra);
  draw(image, 1, bow);
  draw(image, 2, phases);
  draw(image, 3, psfs);
  return image;
}

pipeline::Image draw_curves(std::span<const double> positions,
                            std::span<const double> dispersion_rad) {
  pipeline::Image image = blank(dispersion_rad.empty() ? 1 : 2);
  PlotPanel bow =
      curve_panel("K POSITION LESS ITS STRAIGHT LINE (PIXELS) OVER K SAMPLE", bow_of(positions));
  draw(image, 0, bow);
  if (!dispersion_rad.empty()) {
    PlotPanel phase = curve_panel("DISPERSION (RAD) OVER K SAMPLE",
                                  {dispersion_rad.begin(), dispersion_rad.end()});
    draw(image, 1, phase);
  }
  return image;
}

} // namespace octascope::firmware_host
