// Emission lines at known places: the polynomial that comes back, and what is refused.
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/calibration_finder/lamp_lines.h"
#include "tests/support/must.h"

namespace octascope::pipeline {
namespace {

using testing::HasSubstr;

const std::vector<double> argon_nm{800.616, 810.369, 826.452, 840.821, 852.144, 866.794};

double wavelength_nm(double pixel) {
  return 790.3 + 0.0871 * pixel - 3.1e-6 * pixel * pixel - 4e-10 * pixel * pixel * pixel;
}

double pixel_of(double nm) {
  double low = 0;
  double high = 1023;
  for (int i = 0; i < 60; ++i)
    (wavelength_nm((low + high) / 2) < nm ? low : high) = (low + high) / 2;
  return low;
}

// Gaussian lines of unequal strength over a floor, with noise.
std::vector<double> lamp(const std::vector<double>& lines_nm, bool mirrored = false) {
  std::mt19937_64 generator{3};
  std::normal_distribution<double> normal;
  std::vector<double> counts(1024);
  for (std::size_t p = 0; p < counts.size(); ++p) {
    counts[p] = 100 + 4 * normal(generator);
    for (std::size_t i = 0; i < lines_nm.size(); ++i) {
      const double distance = static_cast<double>(p) - pixel_of(lines_nm[i]);
      counts[p] += (800 + 500 * static_cast<double>(i % 3)) * std::exp(-distance * distance / 4);
    }
  }
  if (mirrored)
    std::ranges::reverse(counts);
  return counts;
}

double polynomial(const std::vector<double>& coefficients, double x) {
  double sum = 0;
  for (std::size_t i = coefficients.size(); i-- > 0;)
    sum = sum * x + coefficients[i];
  return sum;
}

TEST(LampLines, give_the_wavelength_of_every_pixel) {
  const auto found = tests::must(find_lamp_lines(lamp(argon_nm), argon_nm, "lamp"));
  ASSERT_EQ(found.polynomial_nm.size(), 4U);
  for (std::size_t i = 0; i < argon_nm.size(); ++i)
    EXPECT_NEAR(found.pixels[i], pixel_of(argon_nm[i]), 0.05);
  double worst = 0;
  for (double p = 100; p < 920; p += 1)
    worst = std::max(worst, std::abs(polynomial(found.polynomial_nm, p) - wavelength_nm(p)));
  fmt::print("  wavelength within {:.5f} nm, lines within {:.5f} nm rms\n", worst, found.rms_nm);
  EXPECT_LT(worst, 0.01);
  EXPECT_LT(found.rms_nm, 0.005);
}

TEST(LampLines, may_fall) {
  const std::vector<double> falling{argon_nm.rbegin(), argon_nm.rend()};
  const auto found = tests::must(find_lamp_lines(lamp(argon_nm, true), falling, "lamp"));
  EXPECT_NEAR(polynomial(found.polynomial_nm, 500), wavelength_nm(1023 - 500), 0.01);
}

TEST(LampLines, refuses_what_cannot_be_matched) {
  const auto message = [](const std::vector<double>& counts, const std::vector<double>& lines) {
    const auto found = find_lamp_lines(counts, lines, "lamp");
    return found ? std::string{} : found.error().message;
  };
  const std::vector<double> five{argon_nm.begin(), argon_nm.end() - 1};
  EXPECT_THAT(message(lamp(five), argon_nm), HasSubstr("5 peaks stand out"));
  EXPECT_THAT(message(lamp(argon_nm), five), HasSubstr("not clear"));
  EXPECT_THAT(message(lamp(argon_nm), {800, 810}), HasSubstr("at least 3"));
  EXPECT_THAT(message(lamp(argon_nm), {800, 810, 805}), HasSubstr("order of the pixels"));
  auto wrong = argon_nm;
  wrong[2] = 832;
  EXPECT_THAT(message(lamp(argon_nm), wrong), HasSubstr("do not fit"));
  auto bad = lamp(argon_nm);
  bad[17] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(message(bad, argon_nm), HasSubstr("sample 17 is nan"));
  EXPECT_THAT(message(std::vector<double>(1024, 5.0), argon_nm), HasSubstr("0 peaks"));
  EXPECT_THAT(message({}, argon_nm), HasSubstr("no samples"));
}

} // namespace
} // namespace octascope::pipeline
