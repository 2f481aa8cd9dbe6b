#include <cmath>
#include <complex>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "pipeline/angiography/bulk_motion.h"
#include "tests/support/files/fresh_seed.h"

namespace octascope::pipeline {
namespace {

// A line of random reflectors as its transform has it between bins as well: the spectrum has a Hann
// window; with zero-padding, bins lie half as far apart.
class TransformedLine {
public:
  TransformedLine(int padding, unsigned seed) : padding_(padding) {
    std::mt19937 generator{seed};
    std::normal_distribution<double> normal;
    for (int m = 0; m < samples; ++m) {
      const double hann = 0.5 - 0.5 * std::cos(2 * std::numbers::pi * (m + 0.5) / samples);
      spectrum_.emplace_back(hann * normal(generator), hann * normal(generator));
    }
  }
  std::complex<double> at(double z) const {
    std::complex<double> sum;
    for (int m = 0; m < samples; ++m)
      sum += spectrum_[static_cast<std::size_t>(m)] *
             std::polar(1.0, -2 * std::numbers::pi * m * z / (padding_ * samples));
    return sum;
  }

private:
  static constexpr int samples = 256;
  int padding_;
  std::vector<std::complex<double>> spectrum_;
};

// The bins at z + shift, but for a phase.
class Shift : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(ZeroPadding, Shift, testing::Values(1, 2));

TEST_P(Shift, gives_the_bins_between_bins) {
  constexpr int depths = 128;
  constexpr int a_scans = 30;
  const unsigned seed = tests::fresh_seed();
  std::vector<PackedBin> sweep;
  for (unsigned a = 0; a < a_scans; ++a) {
    const TransformedLine line{GetParam(), seed + a};
    for (int z = 0; z < depths; ++z)
      sweep.push_back(PackedBin::of(std::complex<float>{line.at(z)}));
  }
  BulkMotionEstimator estimator{a_scans, depths};
  const AxialCoherence coherence = estimator.coherence(sweep.data());
  // Half the band, which the window's middle lies at; a Hann window's correlation is 2/3 and 1/6.
  const double quarter_turns = 2.0 / GetParam();
  EXPECT_LT(std::abs(std::complex<double>{coherence.carrier} -
                     std::polar(1.0, -quarter_turns * std::numbers::pi / 2)),
            0.1);
  EXPECT_NEAR(coherence.correlation[static_cast<std::size_t>(GetParam())], 2.0 / 3, 0.08);
  EXPECT_NEAR(coherence.correlation[static_cast<std::size_t>(2 * GetParam())], 1.0 / 6, 0.1);

  const TransformedLine line{GetParam(), seed};
  for (const float bins : {-3.0F, -1.7F, 0.2F, 0.5F, 2.91F}) {
    const auto shift = FractionalShift::by(bins, coherence);
    const int begin = shift.first(depths);
    const int end = shift.last(depths);
    EXPECT_GE(end - begin, depths - 9);
    std::vector<float> real(depths);
    std::vector<float> imaginary(depths);
    shift.apply(sweep.data(), begin, end, real.data(), imaginary.data());
    std::complex<double> like;
    double found = 0;
    double expected = 0;
    for (int z = begin; z < end; ++z) {
      const std::complex<double> here{real[static_cast<std::size_t>(z)],
                                      imaginary[static_cast<std::size_t>(z)]};
      const auto truth = line.at(z + static_cast<double>(bins));
      like += here * std::conj(truth);
      found += std::norm(here);
      expected += std::norm(truth);
    }
    EXPECT_GT(std::abs(like) / std::sqrt(found * expected), 0.995) << bins;
    EXPECT_NEAR(found / expected, 1, 0.03) << bins;
  }
}

TEST(AxialCoherence, of_short_b_scans_is_that_of_a_hann_window) {
  const std::vector<PackedBin> sweep(4 * 40, PackedBin::of(1.0F));
  BulkMotionEstimator estimator{4, 40};
  EXPECT_NEAR(estimator.coherence(sweep.data()).independent_samples(5), 2.87, 0.01);
}

} // namespace
} // namespace octascope::pipeline
