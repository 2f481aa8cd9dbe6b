// What the background leaves in a B-scan of the twin: a line through all A-scans at the depth of
// what is level in some of them. The simulated spectrometer's own background, which is known,
// leaves none.
#include <algorithm>
#include <span>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "pipeline/reconstruction/reconstructor.h"
#include "sim/spectra/volume_loop.h"
#include "tests/support/must.h"

namespace octascope::pipeline {
namespace {

class BackgroundGhost : public testing::Test {
protected:
  static constexpr int apex_b_scan = 39;
  static constexpr int forceps_b_scan = 48;

  static sim::VolumeLoopConfig config() {
    auto config = tests::must(sim::suggested_loop("anterior_eye"));
    config.volumes = 1;
    return config;
  }

  Reconstructor reconstructor(ReconstructionPath path) const {
    Calibration calibration = Calibration::identity(plan.samples); // the default's background
    calibration.positions = loop->spectrometer().true_k_positions();
    calibration.dispersion_rad = loop->spectrometer().true_dispersion_rad();
    return tests::must(
        Reconstructor::create({calibration, SpectrumFormat{loop->format()}, plan.a_scans, path}));
  }

  // At each depth, the level that three quarters of a B-scan's A-scans exceed.
  std::vector<float> floor_of(const Reconstructor& made, int b_scan,
                              std::span<const float> background) const {
    auto workspace = made.make_workspace();
    std::vector<float> db(made.levels());
    made.reconstruct_b_scan_db(workspace, loop->frame(0, b_scan), db, background);
    const auto depths = static_cast<std::size_t>(made.depths());
    const auto a_scans = static_cast<std::size_t>(plan.a_scans);
    std::vector<float> floor(depths);
    std::vector<float> row(a_scans);
    for (std::size_t z = 0; z < depths; ++z) {
      for (std::size_t a = 0; a < a_scans; ++a)
        row[a] = db[a * depths + z];
      const auto quarter = row.begin() + plan.a_scans / 4;
      std::ranges::nth_element(row, quarter);
      floor[z] = *quarter;
    }
    return floor;
  }

  // By how many decibels the background's line stands out, at the worst depth behind the rest of
  // the background at zero delay.
  float ghost_db(const Reconstructor& made, int b_scan, std::span<const float> background) const {
    const auto true_counts = loop->spectrometer().mean_counts({});
    const std::vector<float> truth(true_counts.begin(), true_counts.end());
    const auto without = floor_of(made, b_scan, truth);
    const auto with = floor_of(made, b_scan, background);
    float worst = 0;
    for (std::size_t z = 12; z < with.size(); ++z)
      worst = std::max(worst, with[z] - without[z]);
    return worst;
  }

  const std::unique_ptr<sim::VolumeLoop> loop = tests::must(sim::VolumeLoop::make(config()));
  const ScanPlan& plan = loop->plan();
};

TEST_F(BackgroundGhost, is_below_the_noise_once_a_volume_has_gone_by) {
  for (const auto path : {ReconstructionPath::fftw, ReconstructionPath::fused}) {
    const auto made = reconstructor(path);
    auto running = tests::must(made.make_running_background(plan.sweeps()));
    for (int sweep = 0; sweep < 3 * plan.sweeps(); ++sweep)
      running.add(loop->frame(0, sweep % plan.sweeps()));
    for (int b = 0; b <= forceps_b_scan; ++b) {
      const auto background = running.add(loop->frame(0, b));
      if (b != apex_b_scan && b != forceps_b_scan)
        continue;
      const float mean = ghost_db(made, b, {});
      const float found = ghost_db(made, b, background);
      fmt::print("  B-scan {}: {:.1f} dB with its own mean, {:.1f} dB with the running one\n", b,
                 mean, found);
      EXPECT_GT(mean, 8) << "there is something to be avoided";
      EXPECT_LT(found, 1);
    }
  }
}

} // namespace
} // namespace octascope::pipeline
