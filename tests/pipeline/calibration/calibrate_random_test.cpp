// Pairs of mirrors on spectrometers drawn at random, new in every run: whatever chirp, dispersion,
// noise, depths and sides, the curves that are found are the true ones.
#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "pipeline/calibration_finder/axial_psf.h"
#include "pipeline/calibration_finder/mirror_pair.h"
#include "sim/spectrometer/spectrometer.h"
#include "tests/support/files/fresh_seed.h"

namespace octascope::pipeline {
namespace {

struct Case {
  sim::SpectrometerConfig config;
  std::array<double, 2> bins{}; // of the mirrors; negative: beyond zero delay
  double amplitude_counts = 0;
  bool dark = false;
  int lines = 1; // averaged

  SampleSide side() const {
    if (bins[0] > 0)
      return bins[1] > 0 ? SampleSide::both_mirrors : SampleSide::first_mirror;
    return bins[1] > 0 ? SampleSide::second_mirror : SampleSide::no_mirror;
  }
  std::string describe() const {
    return fmt::format("N {}, bow {:+.3f}, skew {:+.2f}, dispersion {:+.1f} and {:+.1f} rad, "
                       "mirrors at {:+.1f} and {:+.1f}, amplitude {:.0f}, noise {:.1f} counts, "
                       "{} lines{}",
                       config.samples, config.chirp_bow, config.chirp_skew,
                       config.dispersion_quadratic_rad, config.dispersion_cubic_rad, bins[0],
                       bins[1], amplitude_counts, config.read_noise_counts, lines,
                       dark ? ", darks" : "");
  }
};

Case draw_case(std::mt19937_64& generator, int fewest_lines, bool always_dark) {
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>{low, high}(generator);
  };
  Case c;
  const int samples[] = {512, 1000, 1024, 2048};
  c.config.samples = samples[generator() % 4];
  c.config.chirp_bow = between(-0.08, 0.08);
  c.config.chirp_skew = between(-0.15, 0.15);
  c.config.read_noise_counts = between(1, 6);
  c.config.seed = generator();
  c.dark = always_dark || generator() % 2 == 0;
  c.amplitude_counts = between(300, 500);
  c.lines = fewest_lines + static_cast<int>(generator() % 4);
  const double share = c.config.samples / 1024.0;
  const double near = between(50, 110) * share;
  c.bins = {near, near + between(90, 160) * share};
  // Dispersion may bend the nearer fringe by less than its own frequency.
  const double bend = std::min(30.0, 0.25 * near);
  c.config.dispersion_quadratic_rad = between(-bend, bend);
  c.config.dispersion_cubic_rad = between(-bend, bend) / 5;
  for (double& bin : c.bins)
    bin = generator() % 4 == 0 ? -bin : bin;
  if (generator() % 2 == 0)
    std::swap(c.bins[0], c.bins[1]);
  return c;
}

std::vector<double> mirror_line(const sim::Spectrometer& s, const Case& c, double bin,
                                std::mt19937_64& generator) {
  const double phase = std::uniform_real_distribution<double>{0, 6.28}(generator);
  const sim::Reflector mirror{bin, c.amplitude_counts, phase};
  const std::vector<double> mean = s.mean_counts({&mirror, 1});
  const std::vector<double> light = s.mean_counts({});
  std::normal_distribution<double> normal;
  std::vector<double> line(mean.size());
  for (std::size_t p = 0; p < line.size(); ++p) {
    const double deviation = std::sqrt(mean[p] / c.config.electrons_per_count +
                                       c.config.read_noise_counts * c.config.read_noise_counts);
    for (int a = 0; a < c.lines; ++a)
      line[p] +=
          std::clamp(std::round(mean[p] + deviation * normal(generator)), 0.0, 4095.0) / c.lines;
    if (c.dark)
      line[p] -= light[p];
  }
  return line;
}

// `y` less its best straight line over x.
std::vector<double> bend_of(const std::vector<double>& x, const std::vector<double>& y) {
  double mx = 0;
  double my = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    mx += x[i] / static_cast<double>(x.size());
    my += y[i] / static_cast<double>(x.size());
  }
  double xx = 0;
  double xy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    xx += (x[i] - mx) * (x[i] - mx);
    xy += (x[i] - mx) * (y[i] - my);
  }
  std::vector<double> bend(x.size());
  for (std::size_t i = 0; i < x.size(); ++i)
    bend[i] = y[i] - my - (x[i] - mx) * xy / xx;
  return bend;
}

double rms_of(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values)
    sum += value * value;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

double greatest_of(const std::vector<double>& values) {
  double most = 0;
  for (const double value : values)
    most = std::max(most, std::abs(value));
  return most;
}

struct Errors {
  std::vector<double> positions_px;
  std::vector<double> dispersion_rad;
};

// Over the central 80 %: offset and scale of k are free (a pair of mirrors does not give them), and
// so are offset and slope of the phase (they are depth).
Errors errors_of(const MirrorPair& found, const sim::Spectrometer& s) {
  const std::size_t n = found.positions.size();
  std::vector<double> m_found;
  std::vector<double> m_true;
  std::vector<double> theta;
  double slope = 0;
  for (std::size_t m = n / 10; m < n - n / 10; ++m) {
    const auto p = std::min(static_cast<std::size_t>(found.positions[m]), n - 2);
    const double f = found.positions[m] - static_cast<double>(p);
    const auto blend = [&](const std::vector<double>& v) { return v[p] + f * (v[p + 1] - v[p]); };
    m_found.push_back(static_cast<double>(m));
    m_true.push_back(blend(s.k_of_pixel()));
    theta.push_back(found.dispersion_rad[m] - blend(s.dispersion_of_pixel_rad()));
    slope = std::max(slope, found.positions[m + 1] - found.positions[m]);
  }
  Errors errors{bend_of(m_found, m_true), bend_of(m_true, theta)};
  for (double& error : errors.positions_px)
    error *= slope;
  return errors;
}

struct Worst {
  double rms = 0;
  double greatest = 0;

  void add(const std::vector<double>& errors) {
    rms = std::max(rms, rms_of(errors));
    greatest = std::max(greatest, greatest_of(errors));
  }
};

// At most 0.05 pixel and rad of what `measure` makes of the errors over the central 80 %.
void expect_true_curves(int fewest_lines, bool always_dark,
                        double (*measure)(const std::vector<double>&)) {
  constexpr int rounds = 30;
  std::mt19937_64 generator{tests::fresh_seed()};
  Worst r;
  Worst theta;
  for (int round = 0; round < rounds; ++round) {
    const Case c = draw_case(generator, fewest_lines, always_dark);
    const auto s = sim::Spectrometer::make(c.config);
    ASSERT_TRUE(s) << s.error().message;
    const auto first = mirror_line(*s, c, c.bins[0], generator);
    const auto second = mirror_line(*s, c, c.bins[1], generator);
    const auto found = find_mirror_pair(first, second, c.side());
    ASSERT_TRUE(found) << found.error().message << "; " << c.describe();
    EXPECT_NEAR(found->depth_bins[1] - found->depth_bins[0],
                std::abs(c.bins[1]) - std::abs(c.bins[0]), 0.5)
        << c.describe();
    Calibration calibration = Calibration::identity(c.config.samples);
    calibration.positions = found->positions;
    calibration.dispersion_rad = found->dispersion_rad;
    for (const std::size_t i : {0U, 1U})
      EXPECT_LE(measure_axial_psf(remove_slow_part(i == 0 ? first : second), calibration,
                                  found->theta_sign[i])
                    .fwhm_bins,
                3.2)
          << c.describe();
    const Errors errors = errors_of(*found, *s);
    r.add(errors.positions_px);
    theta.add(errors.dispersion_rad);
    EXPECT_LE(measure(errors.positions_px), 0.05) << c.describe();
    EXPECT_LE(measure(errors.dispersion_rad), 0.05) << c.describe();
  }
  fmt::print("  worst of {}: r {:.4f} pixel rms, {:.4f} anywhere; theta {:.4f} rad rms, {:.4f} "
             "anywhere\n",
             rounds, r.rms, r.greatest, theta.rms, theta.greatest);
}

// Without darks the pattern of the camera stays, however many lines are averaged.
TEST(RandomMirrors, with_darks_and_averaged_lines_give_the_true_curves_everywhere) {
  expect_true_curves(64, true, greatest_of);
}

TEST(RandomMirrors, single_noisy_lines_give_the_true_curves) {
  expect_true_curves(1, false, rms_of);
}

} // namespace
} // namespace octascope::pipeline
