// Shifts of volumes of scatterers that moved by known amounts.
#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdint>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "pipeline/vessels/following/volume_motion.h"
#include "pipeline/vessels/vectors.h"
#include "tests/support/files/fresh_seed.h"

namespace octascope::pipeline {
namespace {

const VolumeGeometry field{.depths = 256,
                           .a_scans = 150,
                           .b_scans = 60,
                           .depth_spacing_um = 5,
                           .a_spacing_um = 15,
                           .b_spacing_um = 37.5};

struct Scatterer {
  Point at{}; // in voxels of a, b, z
  std::complex<float> amplitude;
};

// Tissue below a surface that undulates, with denser and emptier regions as large as glands, some
// vessels' lumens among them; it is larger than the field on all sides.
class Tissue {
public:
  explicit Tissue(unsigned seed) : random_{seed} {
    for (int i = 0; i < 60; ++i)
      blobs_.push_back({{number(-40, 190), number(-16, 76), number(40, 230)}, number(-1, 1.2)});
    constexpr int count = 60'000;
    std::normal_distribution<float> normal;
    for (int i = 0; i < count; ++i) {
      const Point at{number(-40, 190), number(-16, 76), number(0, 256)};
      const double depth = at[2] - surface(at);
      if (depth > 0)
        scatterers_.push_back({at, static_cast<float>(brightness(at, depth)) *
                                       std::complex{normal(random_), normal(random_)}});
    }
  }

  // Moved, with noise of its own.
  Volume volume(const Point& shift_mm, unsigned noise_seed) const {
    std::vector<std::complex<float>> bins(field.voxels());
    const Point shift{shift_mm[0] / 0.015, shift_mm[1] / 0.0375, shift_mm[2] / 0.005};
    for (const Scatterer& s : scatterers_)
      spread(bins, sum(s.at, shift), s.amplitude);
    Volume made{field};
    std::ranges::fill(made.b_scan_states, BScanState::good);
    std::mt19937 random{noise_seed};
    std::normal_distribution<float> noise{0, 0.15F};
    for (std::size_t i = 0; i < bins.size(); ++i) {
      const float power = std::norm(bins[i] + std::complex{noise(random), noise(random)});
      made.levels[i] =
          static_cast<std::uint8_t>(std::clamp(90 + 20 * std::log10(power + 1e-3F), 0.0F, 255.0F));
    }
    return made;
  }

private:
  struct Blob {
    Point at;
    double strength;
  };

  double number(double low, double high) {
    return std::uniform_real_distribution{low, high}(random_);
  }
  static double surface(const Point& at) {
    return 50 + 8 * std::sin(at[0] / 25) + 6 * std::cos(at[1] / 9);
  }
  double brightness(const Point& at, double depth) const {
    double log_gain = -depth / 120;
    for (const Blob& blob : blobs_) {
      const Point away = difference(at, blob.at);
      log_gain +=
          blob.strength *
          std::exp(-(away[0] * away[0] / 150 + away[1] * away[1] / 24 + away[2] * away[2] / 900));
    }
    return std::exp(log_gain);
  }
  static void spread(std::vector<std::complex<float>>& bins, const Point& at,
                     std::complex<float> amplitude) {
    const auto near = [](double c, int i) { return static_cast<int>(std::floor(c)) + i; };
    for (int db = 0; db < 2; ++db)
      for (int da = -1; da < 3; ++da)
        for (int dz = -1; dz < 3; ++dz) {
          const int a = near(at[0], da), b = near(at[1], db), z = near(at[2], dz);
          if (a < 0 || b < 0 || z < 0 || a >= field.a_scans || b >= field.b_scans ||
              z >= field.depths)
            continue;
          const double far = (a - at[0]) * (a - at[0]) / 1.5 + (b - at[1]) * (b - at[1]) / 0.5 +
                             (z - at[2]) * (z - at[2]) / 1.5;
          // The phase turns with depth as that of a spectrum's centre.
          const std::complex<float> phase = std::polar(1.0F, static_cast<float>(2.5 * at[2]));
          bins[static_cast<std::size_t>((b * field.a_scans + a) * field.depths + z)] +=
              amplitude * phase * static_cast<float>(std::exp(-far));
        }
  }

  std::mt19937 random_;
  std::vector<Blob> blobs_;
  std::vector<Scatterer> scatterers_;
};

class VolumeMotionTest : public testing::Test {
protected:
  VolumeShift shift(const Volume& from, const Volume& to) {
    const auto a = motion_.spectrum(from.levels, from.b_scan_states);
    const auto b = motion_.spectrum(to.levels, to.b_scan_states);
    return a && b ? motion_.shift(*a, *b) : VolumeShift{};
  }

  VolumeMotion motion_{field};
  const unsigned seed_ = tests::fresh_seed();
};

TEST_F(VolumeMotionTest, finds_shifts_between_voxels) {
  const Tissue tissue{seed_};
  const Volume first = tissue.volume({}, 1);
  unsigned noise = 2;
  for (const Point& moved : {Point{0.1, -0.05, 0.03}, Point{-0.011, 0.017, -0.004},
                             Point{0.4, 0.3, -0.06}, Point{-0.3, -0.5, 0.1}}) {
    const VolumeShift found = shift(first, tissue.volume(moved, noise++));
    EXPECT_TRUE(found.found) << found.quality;
    for (std::size_t axis = 0; axis < 3; ++axis)
      EXPECT_NEAR(found.shift_mm[axis], moved[axis], axis == 1 ? 0.018 : 0.008)
          << axis << " of " << moved[0];
  }
}

TEST_F(VolumeMotionTest, bears_missing_b_scans) {
  const Tissue tissue{seed_};
  const Point moved{0.08, 0.06, -0.03};
  Volume next = tissue.volume(moved, 2);
  std::mt19937 random{seed_};
  for (int b = 0; b < field.b_scans; ++b)
    if (random() % 5 == 0) {
      next.b_scan_states[static_cast<std::size_t>(b)] = BScanState::missing;
      std::ranges::fill(next.b_scan(b), std::uint8_t{0});
    }
  const VolumeShift found = shift(tissue.volume({}, 1), next);
  EXPECT_TRUE(found.found);
  for (std::size_t axis = 0; axis < 3; ++axis)
    EXPECT_NEAR(found.shift_mm[axis], moved[axis], 0.02);
}

TEST_F(VolumeMotionTest, refuses_another_place_and_what_is_mostly_missing) {
  for (unsigned i = 0; i < 2; ++i) {
    const VolumeShift found =
        shift(Tissue{seed_ + 2 * i}.volume({}, 1), Tissue{seed_ + 2 * i + 1}.volume({}, 2));
    EXPECT_FALSE(found.found);
    EXPECT_LT(found.quality, least_shift_quality * 0.6);
  }
  Volume missing{field};
  EXPECT_FALSE(motion_.spectrum(missing.levels, missing.b_scan_states));
}

} // namespace
} // namespace octascope::pipeline
