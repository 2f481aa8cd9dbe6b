// Complex bins of repeated sweeps over scatterers, by their definition: a Gaussian beam, the axial
// point spread of a Hann window, noise through the same window. Some scatterers are others in each
// repeat: they flow.
#pragma once

#include <cmath>
#include <complex>
#include <numbers>
#include <random>
#include <vector>

#include "pipeline/volume/packed_bin.h"

namespace octascope::tests {

struct SpeckleTube {
  double a = 0; // centre and radii, in A-scans and depths
  double z = 0;
  double radius_a = 4;
  double radius_z = 10;

  bool contains(double at_a, double at_z) const {
    return std::hypot((at_a - a) / radius_a, (at_z - z) / radius_z) < 1;
  }
};

struct SpeckleScene {
  int a_scans = 96;
  int depths = 320;
  int repeats = 2;
  double surface = 30;
  double snr_db = 25;                           // at the surface
  double fall_db_per_depth = 0.1;               // 17 dB a third of a millimetre deeper
  double bulk_phase = 1;                        // of random phases of A-scans, in turns
  std::vector<double> axial_shifts{0, 0, 0, 0}; // of each repeat, in depths
  std::vector<double> lateral_shifts{0, 0, 0, 0};
  std::vector<SpeckleTube> tubes{};

  bool flows(int a, int z) const {
    for (const auto& tube : tubes)
      if (tube.contains(a, z))
        return true;
    return false;
  }
  // Power of tissue relative to noise, which has the power 1.
  double power(double z) const {
    return z < surface ? 0 : std::pow(10, (snr_db - fall_db_per_depth * (z - surface)) / 10);
  }
  std::size_t voxels() const { return static_cast<std::size_t>(a_scans * depths); }
};

class SpeckleSweeps {
public:
  SpeckleSweeps(const SpeckleScene& scene, unsigned seed) : scene_(scene), generator_(seed) {}

  // [repeat][a][z]
  std::vector<pipeline::PackedBin> bins() {
    std::vector<pipeline::PackedBin> all;
    const auto fixed = scatterers();
    for (int m = 0; m < scene_.repeats; ++m) {
      std::vector<std::complex<double>> sweep(scene_.voxels());
      for (const auto& s : fixed)
        if (!in_tube(s))
          draw(s, m, sweep);
      for (const auto& s : scatterers())
        if (in_tube(s))
          draw(s, m, sweep);
      turn_phases(sweep);
      add_noise(sweep);
      for (const auto& bin : sweep)
        all.push_back(pipeline::PackedBin::of(std::complex<float>{bin}));
    }
    return all;
  }

private:
  struct Scatterer {
    double a, z;
    std::complex<double> amplitude;
  };

  static constexpr double per_voxel = 2;
  static constexpr double beam = 1.4; // radius of the amplitude at 1/e, in A-scans
  static constexpr double margin = 8;

  bool in_tube(const Scatterer& s) const {
    for (const auto& tube : scene_.tubes)
      if (tube.contains(s.a, s.z))
        return true;
    return false;
  }

  std::complex<double> random_bin(double power) {
    const double sigma = std::sqrt(power / 2);
    return {sigma * normal_(generator_), sigma * normal_(generator_)};
  }

  std::vector<Scatterer> scatterers() {
    std::uniform_real_distribution<double> a{-margin, scene_.a_scans + margin};
    std::uniform_real_distribution<double> z{scene_.surface, scene_.depths + margin};
    const auto count = static_cast<std::size_t>(per_voxel * (scene_.a_scans + 2 * margin) *
                                                (scene_.depths + margin - scene_.surface));
    // Energies of beam and point spread: the mean power of a bin is that of the scene.
    const double spread = beam * std::sqrt(std::numbers::pi / 2) * 0.375;
    std::vector<Scatterer> result(count);
    for (auto& s : result) {
      s.a = a(generator_);
      s.z = z(generator_);
      s.amplitude = random_bin(scene_.power(s.z) / (per_voxel * spread));
    }
    return result;
  }

  static double sinc(double x) {
    x *= std::numbers::pi;
    return std::abs(x) < 1e-9 ? 1 : std::sin(x) / x;
  }
  static double point_spread(double x) {
    return 0.5 * sinc(x) + 0.25 * (sinc(x - 1) + sinc(x + 1));
  }

  void draw(const Scatterer& s, int m, std::vector<std::complex<double>>& sweep) const {
    const double at_a = s.a + scene_.lateral_shifts[static_cast<std::size_t>(m)];
    const double at_z = s.z + scene_.axial_shifts[static_cast<std::size_t>(m)];
    const int first_z = std::max(0, static_cast<int>(std::ceil(at_z - 4)));
    const int last_z = std::min(scene_.depths - 1, static_cast<int>(at_z + 4));
    std::complex<double> column[10];
    for (int z = first_z; z <= last_z; ++z)
      column[z - first_z] =
          s.amplitude * point_spread(z - at_z) * std::polar(1.0, std::numbers::pi * (z - at_z));
    const int last_a = std::min(scene_.a_scans - 1, static_cast<int>(at_a + 3));
    for (int a = std::max(0, static_cast<int>(std::ceil(at_a - 3))); a <= last_a; ++a) {
      const double weight = std::exp(-(a - at_a) * (a - at_a) / (beam * beam));
      for (int z = first_z; z <= last_z; ++z)
        sweep[static_cast<std::size_t>(a * scene_.depths + z)] += weight * column[z - first_z];
    }
  }

  void turn_phases(std::vector<std::complex<double>>& sweep) {
    std::uniform_real_distribution<double> phase{-std::numbers::pi, std::numbers::pi};
    for (int a = 0; a < scene_.a_scans; ++a) {
      const auto turn = std::polar(1.0, scene_.bulk_phase * phase(generator_));
      for (int z = 0; z < scene_.depths; ++z)
        sweep[static_cast<std::size_t>(a * scene_.depths + z)] *= turn;
    }
  }

  void add_noise(std::vector<std::complex<double>>& sweep) {
    std::vector<std::complex<double>> white(static_cast<std::size_t>(scene_.depths) + 2);
    for (int a = 0; a < scene_.a_scans; ++a) {
      for (auto& w : white)
        w = random_bin(1 / 0.375);
      for (std::size_t z = 0; z + 2 < white.size(); ++z)
        sweep[static_cast<std::size_t>(a * scene_.depths) + z] +=
            0.5 * white[z + 1] - 0.25 * (white[z] + white[z + 2]);
    }
  }

  SpeckleScene scene_;
  std::mt19937 generator_;
  std::normal_distribution<double> normal_;
};

} // namespace octascope::tests
