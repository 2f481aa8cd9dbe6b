// How far the tissue moved as a whole from one volume to another.
//
// Phase correlation in three dimensions (Kuglin, Hines, Proc. IEEE Int. Conf. Cybernetics and Society,
// 1975) of volumes averaged to at most 96 voxels along each axis, faded out towards their borders; high
// frequencies, which speckle and noise have changed, count less. Between voxels, by a parabola through
// the logarithms of three values (a Gaussian's peak).
#pragma once

#include <array>
#include <complex>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "pipeline/vessels/rigid_transform.h"
#include "pipeline/volume/volume.h"

namespace octascope::pipeline {

// A volume's spectrum, which is what shifts are found from: some 2 MB.
struct VolumeSpectrum {
  std::vector<std::complex<float>> bins;
};

struct VolumeShift {
  Point shift_mm{};   // what was at p of the first is at p + shift_mm of the second
  double quality = 0; // height of the peak: 1 if the second is the first moved round
  bool found = false; // quality is at least least_shift_quality, and no more than a third of a side
};

// Of volumes that have nothing in common it is below half of that (docs/ANGIOGRAPHY.md).
inline constexpr double least_shift_quality = 0.12;

// For volumes of one geometry. From one thread at a time; takes some 10 ms a volume: not for threads
// that others wait for.
class VolumeMotion {
public:
  explicit VolumeMotion(const VolumeGeometry& geometry);
  ~VolumeMotion();
  VolumeMotion(VolumeMotion&&) noexcept;
  VolumeMotion& operator=(VolumeMotion&&) noexcept;

  // `levels` and `states` as in Volume. Missing B-scans are taken from the next ones that are there;
  // empty if more than half are missing.
  std::optional<VolumeSpectrum> spectrum(std::span<const std::uint8_t> levels,
                                         std::span<const BScanState> states);
  VolumeShift shift(const VolumeSpectrum& from, const VolumeSpectrum& to);

private:
  struct Transforms;
  VolumeGeometry geometry_;
  std::array<int, 3> averaged_{}; // voxels to one, along x, y, z of registration.h
  std::array<int, 3> cells_{};    // likewise
  std::unique_ptr<Transforms> transforms_;
};

} // namespace octascope::pipeline
