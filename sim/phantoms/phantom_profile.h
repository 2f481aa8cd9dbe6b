// Converts a column of layers and surfaces to the amplitudes that the spectrometer sees: scatterers
// with speckle, attenuated by what lies above.
#pragma once

#include <array>
#include <complex>
#include <cstdint>
#include <span>
#include <vector>

#include "pipeline/volume/volume.h"
#include "sim/phantoms/phantom_column.h"
#include "sim/phantoms/scatterer_motion.h"
#include "sim/spectrometer/noise.h"
#include "sim/spectrometer/spectrometer.h"

namespace octascope::sim {

// One pass of the beam over a place.
struct Visit {
  std::uint64_t number = 0; // counts sweeps; repeats of a B-scan follow each other
  int repeat = 0;           // of its B-scan's, from 0
  int repeats = 1;
  // When the beam was there in repeat 0 … `repeat`, since any moment.
  std::array<double, most_repeats> times_s{};
};

// Speckle is a circular Gaussian number per voxel, a hash of its place, so static tissue keeps its
// speckle. Neighbouring A-scans share half of it, as overlapping beams do. In a flowing layer the
// hash includes the volume: until the next one (about 100 ms) blood moves by more than a resolution
// cell, so its speckle is uncorrelated. Between repeats of a B-scan (about 2 ms) it changes as
// scatterer_motion.h says, and tissue below it in part.
//
// Immutable, so thread-safe; each thread has its own Profile.
class ProfileMaker {
public:
  struct Profile {
    std::vector<std::complex<float>> scatterers; // one per depth bin
    std::vector<Reflector> surfaces;

    std::vector<float> amplitude; // work space, one per depth bin
    std::vector<float> transmission;
    std::vector<std::uint8_t> flowing; // 1 + the layer that flows there; 0: none
    std::vector<float> flowing_share;  // of the bin's depth
  };

  ProfileMaker(const pipeline::VolumeGeometry& geometry, std::uint64_t seed);

  Profile make_profile() const;

  // Computes the profile of `column` at a place (mm from the field's centre). Allocates nothing.
  void fill(Profile& profile, const Column& column, float x_mm, float y_mm,
            const Visit& visit) const;

private:
  // Where the speckle of a place comes from: two places beside it, and their weights.
  struct SpeckleKeys {
    std::uint64_t b = 0;
    std::uint64_t a = 0;
    float first_weight = 0; // of `a`; the second of a + 1
    float second_weight = 0;
  };

  SpeckleKeys keys_of(float x_mm, float y_mm) const;
  void paint(Profile& profile, const Column& column, std::size_t layer, float x_mm,
             float y_mm) const;
  float grain(const Layer& layer, float x_mm, float y_mm, int depth) const;
  void attenuate(Profile& profile, std::span<const Surface> surfaces) const;
  void speckle(Profile& profile, const SpeckleKeys& keys) const;
  void renew_blood(Profile& profile, const SpeckleKeys& keys, std::uint64_t visit) const;
  void move_blood(Profile& profile, const Column& column, const SpeckleKeys& keys,
                  const Visit& visit) const;

  std::uint64_t seed_;
  int depths_;
  float depth_spacing_mm_;
  float a_spacing_mm_;
  float b_spacing_mm_;
  GaussianTable gaussian_;
};

} // namespace octascope::sim
