// Draws docs/roll-off.png: what each interpolation loses and adds over depth, measured on the
// reconstruction of reflectors through a chirp of 70 pixels in 1024 and dispersion.
//
//   build/release/tests/roll_off_figure docs/roll-off.png
//
// The same figures in numbers go to standard output.
#include <algorithm>
#include <array>
#include <vector>

#include <fmt/format.h>

#include "firmware-host/commands/line_plot.h"
#include "tests/support/spectra/roll_off.h"

namespace octascope {
namespace {

constexpr int samples = 1024;
constexpr int steps = 100; // of the depth range, per cent

struct Curves {
  std::vector<double> level_db;    // of the peak against theory; not a number where not measured
  std::vector<double> artefact_db; // highest elsewhere, against the peak
};

// At each depth the mean loss and the highest artefact of reflectors on and between the bins, with
// random phases.
hal::Result<Curves> measure(pipeline::Interpolation interpolation) {
  pipeline::Calibration calibration = tests::chirped_calibration(samples, 70);
  calibration.dispersion_rad = tests::dispersion(samples, 40, -25);
  calibration.interpolation = interpolation;
  Curves curves{std::vector<double>(steps + 1, std::nan("")),
                std::vector<double>(steps + 1, std::nan(""))};
  for (int percent = 5; percent <= 95; ++percent) {
    std::vector<double> depths;
    for (int i = 0; i < 20; ++i)
      depths.push_back(percent * samples / 200.0 + (i - 10) / 10.0);
    HAL_TRY(const auto points,
            tests::measure_roll_off(calibration, depths, static_cast<std::uint64_t>(percent),
                                    pipeline::ReconstructionPath::automatic));
    double loss = 0;
    double artefact = -999;
    for (const tests::RollOffPoint& point : points) {
      loss += point.loss_db / static_cast<double>(points.size());
      artefact = std::max(artefact, point.peak.artefact_db);
    }
    curves.level_db[static_cast<std::size_t>(percent)] = -loss;
    curves.artefact_db[static_cast<std::size_t>(percent)] = artefact;
  }
  return curves;
}

hal::Result<> draw(const std::string& file) {
  using firmware_host::Colour;
  struct Kind {
    pipeline::Interpolation interpolation;
    const char* name;
    Colour colour;
  };
  const std::array kinds{Kind{pipeline::Interpolation::linear, "LINEAR", {200, 70, 20}},
                         Kind{pipeline::Interpolation::cubic, "CUBIC", {20, 130, 60}},
                         Kind{pipeline::Interpolation::sinc8, "SINC8", {20, 80, 190}}};
  firmware_host::PlotPanel levels{
      "PEAK AGAINST THEORY (DB) OVER DEPTH (PER CENT)", {}, 1, steps, -8, 1};
  firmware_host::PlotPanel artefacts{
      "HIGHEST ARTEFACT AGAINST THE PEAK (DB) OVER DEPTH (PER CENT)", {}, 1, steps, -100, 0};
  fmt::print("{:8}{:>12}{:>12}{:>14}\n", "", "depth, %", "loss, dB", "artefacts, dB");
  for (const Kind& kind : kinds) {
    HAL_TRY(auto curves, measure(kind.interpolation));
    for (const std::size_t percent : {5U, 25U, 50U, 75U, 90U, 95U})
      fmt::print("{:8}{:12}{:12.2f}{:14.1f}\n", kind.name, percent, -curves.level_db[percent],
                 curves.artefact_db[percent]);
    levels.curves.push_back({std::move(curves.level_db), kind.colour, kind.name});
    artefacts.curves.push_back({std::move(curves.artefact_db), kind.colour, kind.name});
  }
  pipeline::Image image;
  image.width = 900;
  image.height = 640;
  image.channels = 3;
  image.pixels.assign(900 * 640 * 3, 255);
  firmware_host::draw_panel(image, {0, 0, 900, 320}, levels);
  firmware_host::draw_panel(image, {0, 320, 900, 320}, artefacts);
  return pipeline::write_png(file, image);
}

} // namespace
} // namespace octascope

int main(int count, char** arguments) {
  if (count != 2) {
    fmt::print(stderr, "expected the name of the picture to write: docs/roll-off.png\n");
    return 2;
  }
  const auto drawn = octascope::draw(arguments[1]);
  if (!drawn)
    fmt::print(stderr, "{}\n", drawn.error().message);
  return drawn ? 0 : 1;
}
