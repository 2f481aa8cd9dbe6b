// Reflectors of known depth and strength, through chirp and dispersion, against closed forms: where
// their peaks are and how high, on both paths; and what each interpolation loses with depth.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <hwy/highway.h>

#include "tests/support/files/fresh_seed.h"
#include "tests/support/must.h"
#include "tests/support/spectra/roll_off.h"

namespace octascope::pipeline {
namespace {

using tests::RollOffPoint;

struct Spectrometer {
  int samples;
  double chirp_pixels;
  double quadratic_rad;
  double cubic_rad;
};

Calibration calibration_of(const Spectrometer& s, Interpolation interpolation) {
  Calibration calibration = tests::chirped_calibration(s.samples, s.chirp_pixels);
  calibration.interpolation = interpolation;
  if (s.quadratic_rad != 0 || s.cubic_rad != 0)
    calibration.dispersion_rad = tests::dispersion(s.samples, s.quadratic_rad, s.cubic_rad);
  return calibration;
}

// Anywhere from 5 to 95 % of the range, most of them between two bins.
std::vector<double> random_depths(int samples, int count, std::uint64_t seed) {
  std::mt19937_64 generator{seed};
  std::uniform_real_distribution<double> share{0.05, 0.95};
  std::vector<double> depths;
  for (int i = 0; i < count; ++i)
    depths.push_back(share(generator) * samples / 2);
  return depths;
}

// Deeper than this, the fringe is too fine for the pixels where they lie widest in k: the camera
// itself makes a false fringe of that part, whatever is done to its line.
double finest_depth(const Calibration& calibration) {
  double widest = 0; // step of k from pixel to pixel, in samples
  for (std::size_t m = 1; m < calibration.positions.size(); ++m)
    widest = std::max(widest, 1 / (calibration.positions[m] - calibration.positions[m - 1]));
  return calibration.samples / 2.0 / widest;
}

struct Worst {
  double position_bins = 0;        // as deep as the camera resolves everywhere
  double deeper_position_bins = 0; // beyond that
  double level_db = 0;             // up to half the range
};

Worst worst_of(const std::vector<RollOffPoint>& points, const Calibration& calibration) {
  Worst worst;
  const double finest = finest_depth(calibration);
  for (const RollOffPoint& point : points) {
    double& bins = point.depth_bin <= finest ? worst.position_bins : worst.deeper_position_bins;
    bins = std::max(bins, std::abs(point.peak.depth_bin - point.depth_bin));
    if (point.depth_bin <= calibration.samples / 4.0)
      worst.level_db = std::max(worst.level_db, std::abs(point.loss_db));
  }
  return worst;
}

std::string name(const Spectrometer& s) {
  return fmt::format("n{}_chirp{}{}_{}", s.samples, s.chirp_pixels < 0 ? "m" : "",
                     std::abs(s.chirp_pixels), s.quadratic_rad == 0 ? "plain" : "dispersed");
}

template <class Case> std::string name_of(const testing::TestParamInfo<Case>& info) {
  return name(info.param);
}

class DepthOracle : public testing::TestWithParam<Spectrometer> {};

TEST_P(DepthOracle, finds_every_reflector_where_and_as_strong_as_it_is) {
  const Spectrometer& s = GetParam();
  const std::uint64_t seed = tests::fresh_seed();
  const Calibration calibration = calibration_of(s, Interpolation::sinc8);
  const std::vector<double> depths = random_depths(s.samples, 200, seed);
  const auto expect_true = [&](ReconstructionPath path, const std::string& isa) {
    const auto points = tests::must(tests::measure_roll_off(calibration, depths, seed, path, isa));
    const Worst worst = worst_of(points, calibration);
    fmt::print("  {:5} {:6}: position within {:.4f} bin to {:.0f} % of the range, {:.4f} beyond; "
               "level within {:.4f} dB to half of it\n",
               path == ReconstructionPath::fftw ? "fftw" : "fused", isa, worst.position_bins,
               200 * finest_depth(calibration) / s.samples, worst.deeper_position_bins,
               worst.level_db);
    EXPECT_LE(worst.position_bins, 0.1) << isa;
    EXPECT_LE(worst.deeper_position_bins, 0.25) << isa;
    EXPECT_LE(worst.level_db, 0.1) << isa;
  };
  expect_true(ReconstructionPath::fftw, "");
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets())
    expect_true(ReconstructionPath::fused, hwy::TargetName(target));
}

INSTANTIATE_TEST_SUITE_P(
    Spectrometers, DepthOracle,
    testing::Values(Spectrometer{1024, 70, 0, 0}, Spectrometer{1024, 70, 40, -25},
                    Spectrometer{1024, -50, -60, 30}, Spectrometer{1024, 0, 30, 10},
                    Spectrometer{1024, 12, 40, -25}, Spectrometer{1024, -12, 40, -25},
                    Spectrometer{2048, 24, -80, 20}, Spectrometer{2048, 140, 80, 20},
                    Spectrometer{1000, 60, -30, 12}, Spectrometer{512, 30, 20, 5}),
    name_of<Spectrometer>);

// docs/RECONSTRUCTION.md has these figures, docs/roll-off.png the curves.
struct RollOff {
  Interpolation interpolation;
  double share_of_depth;
  double most_loss_db;
  double most_artefact_db;
};

std::string name(const RollOff& r) {
  const char* names[] = {"linear", "cubic", "sinc8"};
  return fmt::format("{}_{}", names[static_cast<int>(r.interpolation)], 100 * r.share_of_depth);
}

class InterpolationRollOff : public testing::TestWithParam<RollOff> {};

TEST_P(InterpolationRollOff, is_what_the_documents_say) {
  const RollOff& expected = GetParam();
  const Calibration calibration = calibration_of({1024, 70, 40, -25}, expected.interpolation);
  const double centre = expected.share_of_depth * 512;
  std::vector<double> depths;
  for (int i = -20; i <= 20; ++i)
    depths.push_back(centre + i / 5.0);
  const auto points =
      tests::must(tests::measure_roll_off(calibration, depths, 7, ReconstructionPath::fftw));
  double loss = 0;
  double artefact = -999;
  for (const RollOffPoint& point : points) {
    loss += point.loss_db / static_cast<double>(points.size());
    artefact = std::max(artefact, point.peak.artefact_db);
  }
  fmt::print("  at {:.0f} % of the range: loss {:.3f} dB, artefacts {:.1f} dB\n",
             100 * expected.share_of_depth, loss, artefact);
  EXPECT_LE(loss, expected.most_loss_db);
  EXPECT_LE(artefact, expected.most_artefact_db);
}

INSTANTIATE_TEST_SUITE_P(Kinds, InterpolationRollOff,
                         testing::Values(RollOff{Interpolation::linear, 0.5, 1.9, -36},
                                         RollOff{Interpolation::linear, 0.75, 4.2, -24},
                                         RollOff{Interpolation::cubic, 0.5, 0.65, -42},
                                         RollOff{Interpolation::cubic, 0.75, 2.4, -26.5},
                                         RollOff{Interpolation::sinc8, 0.5, 0.02, -65},
                                         RollOff{Interpolation::sinc8, 0.75, 0.75, -33}),
                         name_of<RollOff>);

} // namespace
} // namespace octascope::pipeline
