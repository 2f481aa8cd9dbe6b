#include <cmath>
#include <complex>
#include <random>

#include <gtest/gtest.h>

#include "pipeline/volume/packed_bin.h"
#include "tests/support/files/fresh_seed.h"

namespace octascope::pipeline {
namespace {

TEST(PackedBin, errs_by_little_and_to_no_side) {
  std::mt19937 generator{tests::fresh_seed()};
  std::uniform_real_distribution<float> exponent{-20, 20};
  constexpr int bins = 100'000;
  double error = 0; // relative
  double power = 0;
  for (int i = 0; i < bins; ++i) {
    const float size = std::exp2(exponent(generator));
    const std::complex<double> packed = PackedBin::of({size, -size / 3}).value();
    const double off = packed.real() / double{size} - 1;
    ASSERT_LE(std::abs(off), PackedBin::most_error);
    ASSERT_LE(std::abs(packed.imag() / double{-size / 3} - 1), PackedBin::most_error);
    error += off;
    power += off * off;
  }
  EXPECT_NEAR(error / bins, 0, 5 * std::sqrt(power) / bins);
  EXPECT_LT(10 * std::log10(power / bins), -55);
}

TEST(PackedBin, keeps_what_has_eight_bits) {
  for (const std::complex<float> bin :
       {std::complex<float>{0, 0}, {1, -1}, {-255, 0.5F}, {0x1p-20F, 0x1.FEp30F}})
    EXPECT_EQ(PackedBin::of(bin).value(), bin);
  EXPECT_EQ(PackedBin{}.value(), std::complex<float>{});
}

} // namespace
} // namespace octascope::pipeline
