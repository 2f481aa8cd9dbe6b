// From a column of layers and surfaces to the amplitudes that the spectrometer sees: scatterers,
// their speckle, and the attenuated light below.
#pragma once

#include <array>
#include <complex>
#include <cstdint>
#include <span>
#include <vector>

#include "pipeline/volume/volume.h"
#include "sim/phantoms/phantom_column.h"
#include "sim/spectrometer/noise.h"
#include "sim/spectrometer/spectrometer.h"

namespace octascope::sim {

// Speckle is a circular Gaussian number for each voxel, a hash of its position: static tissue keeps
// its speckle. Neighbouring A-scans share half of it, as overlapping beams do. In a flowing layer
// the hash includes the visit: between two visits of the beam (B-scans, about 2 ms) blood moves by
// more than a resolution cell, so its speckle is entirely new.
//
// Immutable, so thread-safe; each thread has its own Profile.
class ProfileMaker {
public:
  struct Profile {
    std::vector<std::complex<float>> scatterers; // one per depth bin
    std::vector<Reflector> surfaces;

    std::vector<float> amplitude; // work space, one per depth bin
    std::vector<float> transmission;
    std::vector<std::uint8_t> flowing;
  };

  ProfileMaker(const pipeline::VolumeGeometry& geometry, std::uint64_t seed);

  Profile make_profile() const;

  // The profile of `column` at the given place (mm from the field's centre). `visit` counts the
  // beam's visits. Allocates nothing.
  void fill(Profile& profile, const Column& column, float x_mm, float y_mm,
            std::uint64_t visit) const;

private:
  void paint(Profile& profile, const Layer& layer, float x_mm, float y_mm) const;
  float grain(const Layer& layer, float x_mm, float y_mm, int depth) const;
  void attenuate(Profile& profile, std::span<const Surface> surfaces) const;
  void speckle(Profile& profile, float x_mm, float y_mm, std::uint64_t visit) const;

  std::uint64_t seed_;
  int depths_;
  float depth_spacing_mm_;
  float a_spacing_mm_;
  float b_spacing_mm_;
  GaussianTable gaussian_;
};

} // namespace octascope::sim
