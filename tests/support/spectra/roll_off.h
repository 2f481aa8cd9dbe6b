// Roll-off of an interpolation: what the chain makes of reflectors at depths over the whole range.
#pragma once

#include <cmath>
#include <numbers>
#include <random>
#include <span>
#include <vector>

#include "pipeline/reconstruction/reconstructor.h"
#include "tests/support/files/calibrations.h"
#include "tests/support/spectra/reflector_line.h"

namespace octascope::tests {

struct RollOffPoint {
  double depth_bin = 0;
  ReflectorPeak peak;
  double loss_db = 0; // level of theory less level found
};

// Reflectors at `depths_bin`, one A-scan each with a phase of its own, through
// `calibration` (Hann, background none) on one path.
inline hal::Result<std::vector<RollOffPoint>>
measure_roll_off(const pipeline::Calibration& calibration, const std::vector<double>& depths_bin,
                 std::uint64_t seed, pipeline::ReconstructionPath path,
                 const std::string& isa = {}) {
  constexpr double amplitude = 24000;
  constexpr double offset = 32768;
  const ReflectorLine synthesis{calibration};
  std::mt19937_64 generator{seed};
  std::uniform_real_distribution<double> phases{0, 2 * std::numbers::pi};
  std::vector<std::uint16_t> counts;
  for (const double depth : depths_bin) {
    for (const double count : synthesis.counts(depth, phases(generator), amplitude, offset))
      counts.push_back(static_cast<std::uint16_t>(std::lround(count)));
  }
  pipeline::Calibration known = calibration;
  known.background_mode = pipeline::BackgroundMode::file;
  known.background.assign(static_cast<std::size_t>(known.samples), static_cast<float>(offset));
  auto reconstructor = pipeline::Reconstructor::create({known,
                                                        {known.samples, hal::SampleType::u16},
                                                        static_cast<int>(depths_bin.size()),
                                                        path,
                                                        isa});
  if (!reconstructor)
    return tl::make_unexpected(reconstructor.error());
  auto workspace = reconstructor->make_workspace();
  std::vector<float> levels(reconstructor->levels());
  reconstructor->reconstruct_b_scan_db(workspace, std::as_bytes(std::span{counts}), levels);
  const auto depths = static_cast<std::size_t>(reconstructor->depths());
  std::vector<RollOffPoint> points;
  for (std::size_t a = 0; a < depths_bin.size(); ++a) {
    const auto peak =
        measure_reflector(std::span{levels}.subspan(a * depths, depths), depths_bin[a]);
    points.push_back(
        {depths_bin[a], peak, hann_level_db(amplitude, known.samples) - peak.level_db});
  }
  return points;
}

} // namespace octascope::tests
