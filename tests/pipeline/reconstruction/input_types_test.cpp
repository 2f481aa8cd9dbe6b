// Every type of input, any number of samples, both paths, with input that is new in each run,
// against the double-precision reference.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "pipeline/reconstruction/reconstructor.h"
#include "tests/support/files/calibrations.h"
#include "tests/support/files/fresh_seed.h"
#include "tests/support/spectra/reference_chain.h"

namespace octascope::pipeline {
namespace {

#ifdef OCTASCOPE_SANITIZED
constexpr int lines = 3;
#else
constexpr int lines = 12;
#endif

struct Input {
  const char* name;
  hal::SampleType type;
  int significant_bits;
  int right_shift;
};

constexpr Input inputs[] = {
    {"u8", hal::SampleType::u8, 8, 0},
    {"u8, 6 bits left-justified", hal::SampleType::u8, 6, 2},
    {"u10 in 16", hal::SampleType::u16, 10, 0},
    {"u12 in 16", hal::SampleType::u16, 12, 0},
    {"u10 left-justified", hal::SampleType::u16, 10, 6},
    {"u12 left-justified", hal::SampleType::u16, 12, 4},
    {"u16", hal::SampleType::u16, 16, 0},
    {"f32", hal::SampleType::f32, 16, 0},
};

// The bytes of a B-scan, and what they mean.
struct Spectra {
  std::vector<std::byte> bytes;
  std::vector<double> counts;
};

template <class Value> void append(std::vector<std::byte>& bytes, Value value) {
  const auto* first = reinterpret_cast<const std::byte*>(&value);
  bytes.insert(bytes.end(), first, first + sizeof value);
}

// Light with a hump, fringes and noise; what lies under left-justified counts is noise, too.
Spectra draw(const Input& input, int samples, std::mt19937& generator) {
  const double full_scale = (1 << input.significant_bits) - 1;
  std::uniform_real_distribution<double> share{0, 1};
  Spectra spectra;
  for (int a = 0; a < lines; ++a) {
    const double depth = share(generator) * samples / 2;
    const double phase = share(generator) * 6.28;
    for (int p = 0; p < samples; ++p) {
      const double u = static_cast<double>(p) / samples;
      const double light = 0.1 + 0.5 * std::sin(3.14 * u) +
                           0.15 * std::cos(6.283 * depth * u + phase) + 0.2 * share(generator);
      const double count = std::floor(std::clamp(light, 0.0, 1.0) * full_scale);
      const auto below = static_cast<unsigned>(share(generator) * (1 << input.right_shift));
      const unsigned raw = (static_cast<unsigned>(count) << input.right_shift) | below;
      if (input.type == hal::SampleType::u8)
        append(spectra.bytes, static_cast<std::uint8_t>(raw));
      else if (input.type == hal::SampleType::u16)
        append(spectra.bytes, static_cast<std::uint16_t>(raw));
      else
        append(spectra.bytes, static_cast<float>(light * 4000 - 500));
      spectra.counts.push_back(input.type == hal::SampleType::f32
                                   ? static_cast<double>(static_cast<float>(light * 4000 - 500))
                                   : count);
    }
  }
  return spectra;
}

struct Difference {
  std::size_t counts = 0;
  std::size_t differing = 0;
  double worst = 0; // of a count: what is left when the errors that are allowed are taken off
};

// Weights in Q14 and single precision leave an error in proportion to the B-scan's root mean
// square level, which is nothing but in deep nulls of the spectrum. There a count may differ by as
// much as that error is.
void compare(const std::vector<std::uint8_t>& levels, const std::vector<double>& reference_db,
             double error_floor, Difference& difference) {
  double power = 0;
  for (const double db : reference_db)
    power += std::pow(10, db / 10);
  const double root_mean_square = std::sqrt(power / static_cast<double>(reference_db.size()));
  for (std::size_t i = 0; i < levels.size(); ++i) {
    const int off = std::abs(tests::reference_count(reference_db[i]) - levels[i]);
    const double share = error_floor * root_mean_square / std::pow(10, reference_db[i] / 20);
    // As far below as above: 1 − share goes to nothing where the error is all there is.
    const double allowed = share < 0.9 ? -40 * std::log10(1 - share) : 255;
    difference.differing += off != 0 ? 1 : 0;
    difference.worst = std::max(difference.worst, off - allowed);
  }
  difference.counts += levels.size();
}

class InputTypes : public testing::TestWithParam<Input> {
protected:
  void check(int samples, std::mt19937& generator) {
    const Input& input = GetParam();
    std::uniform_real_distribution<double> share{-1, 1};
    Calibration calibration = tests::chirped_calibration(samples, share(generator) * samples / 16);
    calibration.interpolation = static_cast<Interpolation>(generator() % 3);
    if (generator() % 2 == 0)
      calibration.dispersion_rad =
          tests::dispersion(samples, 60 * share(generator), 40 * share(generator));
    SpectrumFormat format{samples, input.type};
    format.significant_bits = input.significant_bits;
    format.right_shift = input.right_shift;
    const Spectra spectra = draw(input, samples, generator);
    const auto reference = tests::reference_b_scan_db(spectra.counts, lines, calibration);
    for (const auto path : {ReconstructionPath::fftw, ReconstructionPath::fused}) {
      const auto made = Reconstructor::create({calibration, format, lines, path});
      ASSERT_TRUE(made) << made.error().message;
      if (made->path() != path)
        continue; // the fused path does not apply
      auto workspace = made->make_workspace();
      std::vector<std::uint8_t> levels(made->levels());
      made->reconstruct_b_scan(workspace, spectra.bytes, levels);
      const bool fused = path == ReconstructionPath::fused;
      Difference& difference = fused ? fused_ : fftw_;
      compare(levels, reference, fused ? 4e-4 : 2e-6, difference);
      ASSERT_LE(difference.worst, 1)
          << samples << " samples, interpolation " << static_cast<int>(calibration.interpolation)
          << (calibration.dispersion_rad.empty() ? ", real, " : ", dispersion, ")
          << (fused ? "fused" : "fftw");
    }
  }

  static void tell(const char* path, const Difference& difference) {
    if (difference.counts == 0)
      return;
    const std::string share =
        fmt::format("{:.3f}", 100.0 * static_cast<double>(difference.differing) /
                                  static_cast<double>(difference.counts));
    fmt::print("  {}, {}: {} % of {} counts differ\n", GetParam().name, path, share,
               difference.counts);
    RecordProperty(fmt::format("{}_percent_differing", path), share);
  }

  Difference fftw_;
  Difference fused_;
};

TEST_P(InputTypes, agree_with_the_reference_for_any_number_of_samples) {
  std::mt19937 generator{tests::fresh_seed()};
  std::uniform_int_distribution<int> any{16, 3000};
  for (const int samples : {16, 17, 97, 1000, 1009, 1023, 2047})
    ASSERT_NO_FATAL_FAILURE(check(samples, generator));
  for (int i = 0; i < 6; ++i) {
    const int samples = any(generator);
    // One in 370 is a power of two, which both paths take: the next test's.
    ASSERT_NO_FATAL_FAILURE(
        check(samples + (std::has_single_bit(static_cast<unsigned>(samples)) ? 1 : 0), generator));
  }
  tell("fftw", fftw_);
  EXPECT_EQ(fused_.counts, 0U);
}

TEST_P(InputTypes, agree_with_the_reference_for_powers_of_two_on_both_paths) {
  std::mt19937 generator{tests::fresh_seed()};
  for (int i = 0; i < 3; ++i) {
    for (const int samples : {256, 512, 1024, 2048})
      ASSERT_NO_FATAL_FAILURE(check(samples, generator));
  }
  tell("fftw", fftw_);
  tell("fused", fused_);
  const bool covered = GetParam().type == hal::SampleType::u16 ||
                       (GetParam().type == hal::SampleType::u8 && GetParam().right_shift == 0);
  EXPECT_EQ(fused_.counts > 0, covered);
}

std::string name(const testing::TestParamInfo<Input>& info) {
  std::string text{to_string(info.param.type)};
  return text +
         fmt::format("_{}_bits_shift_{}", info.param.significant_bits, info.param.right_shift);
}

INSTANTIATE_TEST_SUITE_P(all, InputTypes, testing::ValuesIn(inputs), name);

} // namespace
} // namespace octascope::pipeline
