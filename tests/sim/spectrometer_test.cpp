#include <cmath>
#include <complex>
#include <numbers>

#include <gtest/gtest.h>

#include "sim/spectrometer/spectrometer.h"
#include "sim/spectrometer/spectrometer_synthesis.h"
#include "tests/sim/exact_inverse.h"
#include "tests/support/fails_with.h"

namespace octascope::sim {
namespace {

using tests::ReferenceChain;

Spectrometer default_spectrometer() {
  return *Spectrometer::make({});
}

std::vector<double> without_background(const Spectrometer& s, std::vector<double> counts) {
  const std::vector<double> background = s.mean_counts({});
  for (std::size_t p = 0; p < counts.size(); ++p)
    counts[p] -= background[p];
  return counts;
}

ReferenceChain::Peak measured_peak(const Spectrometer& s, const Reflector& mirror) {
  const ReferenceChain chain(s.true_k_positions(), s.true_dispersion_rad());
  const std::vector<double> counts = without_background(s, s.mean_counts({&mirror, 1}));
  return ReferenceChain::peak(chain.prepare(counts), mirror.depth_bin - 6, mirror.depth_bin + 6);
}

TEST(Spectrometer, a_mirror_comes_back_where_it_was_and_as_bright_as_stated) {
  const Spectrometer s = default_spectrometer();
  const std::vector<double> window = tests::hann(1024);
  for (const double depth : {45.3, 120.75, 250.5, 331.1}) {
    const Reflector mirror{depth, 300, 0.7};
    const ReferenceChain::Peak peak = measured_peak(s, mirror);
    EXPECT_NEAR(peak.depth_bin, depth, 0.1);
    EXPECT_NEAR(peak.level_db, s.mirror_level_db(mirror, window), 0.1) << "at " << depth;
  }
}

TEST(Spectrometer, roll_off_is_that_of_a_pixel_and_a_gaussian_spot) {
  const Spectrometer s = default_spectrometer();
  const auto stated_db = [](double depth) {
    const double f = depth / 1024;
    const double pixel = std::sin(std::numbers::pi * f) / (std::numbers::pi * f);
    const double sigma = 0.9 / (2 * std::sqrt(2 * std::numbers::ln2));
    const double spot = std::exp(-2 * std::pow(std::numbers::pi * sigma * f, 2));
    return 20 * std::log10(pixel * spot);
  };
  const double near = measured_peak(s, {60, 300, 0}).level_db;
  for (const double depth : {150.0, 240.0, 330.0})
    EXPECT_NEAR(measured_peak(s, {depth, 300, 0}).level_db - near, stated_db(depth) - stated_db(60),
                0.1);
  EXPECT_LT(stated_db(512), -8); // a roll-off worth the name
}

TEST(Spectrometer, without_its_curves_a_mirror_is_smeared) {
  const Spectrometer s = default_spectrometer();
  const Reflector mirror{200, 300, 0};
  std::vector<double> even(1024);
  for (std::size_t m = 0; m < even.size(); ++m)
    even[m] = static_cast<double>(m);
  const ReferenceChain chain(even, s.true_dispersion_rad());
  const std::vector<double> counts = without_background(s, s.mean_counts({&mirror, 1}));
  const auto peak = ReferenceChain::peak(chain.prepare(counts), 100, 300);
  EXPECT_LT(peak.level_db, s.mirror_level_db(mirror, chain.window()) - 6);
}

TEST(Spectrometer, curves_have_the_stated_form) {
  const Spectrometer s = default_spectrometer();
  const std::vector<double>& r = s.true_k_positions();
  EXPECT_DOUBLE_EQ(r.front(), 0);
  EXPECT_DOUBLE_EQ(r.back(), 1023);
  double bow = 0;
  for (std::size_t m = 1; m < r.size(); ++m) {
    ASSERT_GT(r[m], r[m - 1]) << "at " << m;
    bow = std::max(bow, std::abs(r[m] - static_cast<double>(m)));
  }
  EXPECT_NEAR(bow, 70, 1);
  // A straight line finds nothing in θ.
  double slope = 0;
  for (std::size_t m = 0; m < r.size(); ++m)
    slope += s.true_dispersion_rad()[m] * (static_cast<double>(m) / 511.5 - 1) / 1024;
  EXPECT_NEAR(slope, 0, 0.1);
  EXPECT_NEAR(s.true_dispersion_rad().front(), 25 - 6, 1e-9);
  EXPECT_NEAR(s.true_dispersion_rad().back(), 25 + 6, 1e-9);
}

TEST(Spectrometer, settings_that_make_no_sense_are_named) {
  SpectrometerConfig wrong;
  wrong.electrons_per_count = std::nan("");
  EXPECT_THAT(Spectrometer::make(wrong), tests::FailsSaying("electrons_per_count"));
  wrong = {};
  for (const int samples : {15, 65537}) {
    wrong.samples = samples;
    EXPECT_THAT(Spectrometer::make(wrong), tests::FailsSaying(std::to_string(samples)));
  }
  wrong = {};
  wrong.chirp_bow = 0.3;
  EXPECT_THAT(Spectrometer::make(wrong), tests::FailsWith(hal::ErrorCode::invalid_argument));
}

TEST(SpectrumSynthesis, agrees_with_the_closed_form) {
  for (const int samples : {64, 250, 1024, 2048}) {
    SpectrometerConfig config;
    config.samples = samples;
    const Spectrometer s = *Spectrometer::make(config);
    const SpectrumSynthesis synthesis(s);
    auto workspace = synthesis.make_workspace();
    const auto n = static_cast<std::size_t>(samples);
    std::vector<std::complex<float>> scatterers(n / 2);
    std::vector<Reflector> all;
    for (const double part : {0.1, 0.33, 0.5, 0.71, 0.9}) {
      const auto bin = static_cast<std::size_t>(part * samples / 2);
      scatterers[bin] = std::polar(100.0F, static_cast<float>(part * 20));
      all.push_back({static_cast<double>(bin), 100, part * 20});
    }
    const std::vector<Reflector> surfaces{{0.123 * samples, 150, 1.1}, {0.377 * samples, 80, 4}};
    all.insert(all.end(), surfaces.begin(), surfaces.end());
    std::vector<float> fast(n);
    // Twice: nothing of the first line may be left.
    synthesis.mean_counts(std::vector<std::complex<float>>(n / 2, 500.0F), {}, workspace, fast);
    synthesis.mean_counts(scatterers, surfaces, workspace, fast);
    const std::vector<double> exact = s.mean_counts(all);
    double worst = 0;
    for (std::size_t p = 0; p < n; ++p)
      worst = std::max(worst, std::abs(static_cast<double>(fast[p]) - exact[p]));
    EXPECT_LT(worst, 0.003 * 730) << samples << " samples"; // of all amplitudes together
  }
}

TEST(SpectrumSynthesis, noise_has_the_stated_variance) {
  const Spectrometer s = default_spectrometer();
  const SpectrumSynthesis synthesis(s);
  for (const float level : {100.0F, 2000.0F}) {
    const std::vector<float> mean(1024, level);
    std::vector<std::uint16_t> counts(1024);
    double sum = 0;
    double squares = 0;
    constexpr int lines = 500;
    for (std::uint64_t line = 0; line < lines; ++line) {
      synthesis.expose(mean, line, counts);
      for (const std::uint16_t count : counts) {
        const double off = static_cast<double>(count) - static_cast<double>(level);
        sum += off;
        squares += off * off;
      }
    }
    const double n = 1024.0 * lines;
    EXPECT_NEAR(sum / n, 0, 0.05);
    // Shot noise, read noise, and that of rounding.
    const double stated = static_cast<double>(level) / 40 + 2 * 2 + 1.0 / 12;
    EXPECT_NEAR(squares / n / stated, 1, 0.02);
  }
}

TEST(SpectrumSynthesis, noise_repeats_with_its_key_only) {
  const SpectrumSynthesis synthesis(default_spectrometer());
  const std::vector<float> mean(1024, 1000);
  std::vector<std::uint16_t> first(1024);
  std::vector<std::uint16_t> again(1024);
  std::vector<std::uint16_t> other(1024);
  synthesis.expose(mean, 7, first);
  synthesis.expose(mean, 7, again);
  synthesis.expose(mean, 8, other);
  EXPECT_EQ(first, again);
  EXPECT_NE(first, other);
}

TEST(SpectrumSynthesis, saturation_clips_at_full_scale_and_at_zero) {
  const Spectrometer s = default_spectrometer();
  const SpectrumSynthesis synthesis(s);
  auto workspace = synthesis.make_workspace();
  std::vector<float> mean(1024);
  const std::vector<std::complex<float>> nothing(512);
  const Reflector glare{100.5, 5000, 0};
  synthesis.mean_counts(nothing, {&glare, 1}, workspace, mean);
  std::vector<std::uint16_t> counts(1024);
  synthesis.expose(mean, 1, counts);
  for (std::size_t p = 0; p < counts.size(); ++p) {
    ASSERT_LE(counts[p], 4095);
    ASSERT_TRUE(mean[p] < 4300 || counts[p] == 4095) << "at " << p;
    ASSERT_TRUE(mean[p] > -100 || counts[p] == 0) << "at " << p;
  }
  EXPECT_GT(std::count(counts.begin(), counts.end(), 4095), 50);
  EXPECT_GT(std::count(counts.begin(), counts.end(), 0), 50);
}

} // namespace
} // namespace octascope::sim
