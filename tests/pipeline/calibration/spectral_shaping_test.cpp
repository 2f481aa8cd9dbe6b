// A source with ripple has side lobes that no window takes away; shaping does.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/calibration/spectral_shaping.h"
#include "pipeline/reconstruction/reconstructor.h"
#include "tests/support/files/calibrations.h"
#include "tests/support/files/test_data.h"
#include "tests/support/must.h"

namespace octascope::pipeline {
namespace {

constexpr int samples = 1024;
constexpr double depth = 150;

// Two humps and a ripple of 12 periods, by pixel.
double light(double p) {
  const double u = p / (samples - 1);
  const auto hump = [u](double centre, double width) {
    return std::exp(-0.5 * std::pow((u - centre) / width, 2));
  };
  return 3000 * (hump(0.38, 0.14) + 0.8 * hump(0.66, 0.12)) *
         (1 + 0.25 * std::cos(2 * std::numbers::pi * 12 * u));
}

SourceShaping ripple_source() {
  SourceShaping shaping;
  for (int p = 0; p < samples; ++p)
    shaping.source.push_back(static_cast<float>(light(p)));
  return shaping;
}

// The levels of a mirror in that light, through a chirp.
std::vector<float> mirror_db(const Calibration& calibration, double chirp) {
  std::vector<float> line;
  for (int p = 0; p < samples; ++p) {
    const double c = 4 * chirp; // p = (n + c)·u − c·u²
    const double b = samples - 1 + c;
    const double u = c == 0 ? static_cast<double>(p) / (samples - 1)
                            : (b - std::sqrt(b * b - 4 * c * p)) / (2 * c);
    line.push_back(static_cast<float>(
        0.1 * light(p) *
        std::cos(2 * std::numbers::pi * depth * u * (samples - 1) / samples + 0.3)));
  }
  const auto made =
      Reconstructor::create({calibration, SpectrumFormat{samples, hal::SampleType::f32}, 1});
  EXPECT_TRUE(made) << made.error().message;
  auto workspace = made->make_workspace();
  std::vector<float> db(made->levels());
  made->reconstruct_b_scan_db(workspace, std::as_bytes(std::span{line}), db);
  return db;
}

struct Psf {
  double peak_db;
  double side_lobe_db; // the highest beyond 6 bins from the peak, relative to it
};

Psf psf_of(const std::vector<float>& db) {
  const auto peak = std::max_element(db.begin() + 6, db.end());
  float highest = -200;
  for (auto z = db.begin() + 30; z != db.end(); ++z)
    highest = std::abs(z - peak) > 6 ? std::max(highest, *z) : highest;
  return {static_cast<double>(*peak), static_cast<double>(highest - *peak)};
}

TEST(SpectralShaping, takes_the_side_lobes_of_a_rippled_source_away) {
  for (const double chirp : {0.0, 70.0}) {
    Calibration calibration = tests::chirped_calibration(samples, chirp);
    calibration.background_mode = BackgroundMode::none;
    const Psf before = psf_of(mirror_db(calibration, chirp));
    const SourceShaping shaping = ripple_source();
    const auto factors = tests::must(
        make_shaping_factors(shaping, calibration.positions, calibration.interpolation));
    calibration.window = factors;
    const Psf after = psf_of(mirror_db(calibration, chirp));
    fmt::print("  chirp {}: side lobes {:.1f} dB with Hann, {:.1f} dB shaped; peak {:.2f} and "
               "{:.2f} dB\n",
               chirp, before.side_lobe_db, after.side_lobe_db, before.peak_db, after.peak_db);
    RecordProperty("side_lobes_db_hann", fmt::format("{:.1f}", before.side_lobe_db));
    RecordProperty("side_lobes_db_shaped", fmt::format("{:.1f}", after.side_lobe_db));
    EXPECT_GT(before.side_lobe_db, -22); // 0.25/2 of the peak: −18 dB
    EXPECT_LT(after.side_lobe_db, before.side_lobe_db - 20);
    EXPECT_NEAR(after.peak_db, before.peak_db, 0.2); // as bright
  }
}

TEST(SpectralShaping, makes_the_spectrum_the_gaussian_it_names) {
  SourceShaping shaping = ripple_source();
  shaping.fwhm = 0.3;
  shaping.highest_gain = 1000;
  const auto calibration = Calibration::identity(samples);
  const auto factors =
      tests::must(make_shaping_factors(shaping, calibration.positions, calibration.interpolation));
  double sum = 0;
  double moment = 0;
  for (int p = 0; p < samples; ++p) {
    sum += light(p);
    moment += light(p) * p;
  }
  const double centre = moment / sum;
  const auto shaped = [&](double p) {
    return light(std::round(p)) * factors[static_cast<std::size_t>(std::lround(p))];
  };
  const double middle = shaped(centre);
  for (const double x : {-0.3, -0.15, -0.05, 0.1, 0.15, 0.3}) {
    const double p = std::round(centre + x * samples);
    const double u = (p - centre) / samples / 0.3;
    EXPECT_NEAR(shaped(p) / middle, std::exp2(-4 * u * u), 1e-3) << x;
  }
}

TEST(SpectralShaping, limits_the_gain_where_the_source_is_weak) {
  SourceShaping shaping;
  for (int p = 0; p < samples; ++p) // a hole in the middle of the spectrum
    shaping.source.push_back(std::abs(p - 500) < 20 ? 0.0F : 1000.0F);
  const auto calibration = Calibration::identity(samples);
  for (const double gain : {2.0, 10.0}) {
    shaping.highest_gain = gain;
    const auto factors = tests::must(
        make_shaping_factors(shaping, calibration.positions, calibration.interpolation));
    EXPECT_NEAR(factors[500] / factors[524], gain, 0.05 * gain);
    for (const double factor : factors) {
      EXPECT_TRUE(std::isfinite(factor));
      EXPECT_GE(factor, 0);
    }
  }
}

TEST(SpectralShaping, refuses_what_is_no_source) {
  const auto calibration = Calibration::identity(samples);
  const auto message = [&](const SourceShaping& shaping) {
    const auto factors =
        make_shaping_factors(shaping, calibration.positions, calibration.interpolation);
    return factors ? std::string{} : factors.error().message;
  };
  SourceShaping shaping = ripple_source();
  EXPECT_EQ(message(shaping), "");
  shaping.source.assign(samples, -1.0F);
  EXPECT_THAT(message(shaping), testing::HasSubstr("source has no light"));
  shaping.source[3] = std::nanf("");
  EXPECT_EQ(message(shaping), "source value 3 is nan, expected a finite number");
  shaping.source.pop_back();
  EXPECT_EQ(message(shaping), "source has 1023 values, expected 1024");
  shaping = ripple_source();
  shaping.fwhm = 0;
  EXPECT_EQ(message(shaping), "fwhm is 0, expected 0.05 to 2");
  shaping = ripple_source();
  shaping.highest_gain = 0.5;
  EXPECT_EQ(message(shaping), "highest_gain is 0.5, expected 1 to 1000");
}

} // namespace
} // namespace octascope::pipeline
