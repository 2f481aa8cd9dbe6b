// The whole way on the twin: a mirror that lags, spectra of a phantom, levels, the offset found in
// them, and sweeps that agree. Judged by where the twin's mirror really was, and by the picture.
#include <chrono>
#include <cmath>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "pipeline/acquisition/b_scan_builder.h"
#include "pipeline/reconstruction/reconstructor.h"
#include "pipeline/scan/scan_lag_estimator.h"
#include "pipeline/scan/scan_lag_tracker.h"
#include "sim/spectra/volume_loop.h"
#include "tests/support/must.h"

namespace octascope {
namespace {

using pipeline::ScanPlan;
using pipeline::SweepAlignment;

struct Twin {
  std::string phantom;
  double lag_a_scans;
  int repeats;
  friend void PrintTo(const Twin& twin, std::ostream* out) { *out << twin.phantom; }
};

class BidirectionalTwin : public testing::TestWithParam<Twin> {
protected:
  void SetUp() override {
    sim::VolumeLoopConfig config = *sim::suggested_loop(GetParam().phantom);
    ScanPlan& plan = config.plan;
    plan.samples = 512;
    plan.depth_spacing_um *= 2;
    plan.b_scans = 40 / GetParam().repeats;
    plan.b_spacing_um *= 80.0 / plan.b_scans;
    plan.bidirectional = true;
    plan.turn_around_lines = 12;
    plan.repeats = GetParam().repeats;
    config.volumes = 2;
    config.galvo_lag_us = GetParam().lag_a_scans / plan.line_rate_hz * 1e6;
    loop = tests::must(sim::VolumeLoop::make(config));
    while (loop->ready_volumes() < 2)
      std::this_thread::sleep_for(std::chrono::milliseconds{2});
    reconstruct_volumes();
  }

  const ScanPlan& plan() const { return loop->plan(); }

  void reconstruct_volumes() {
    auto calibration = pipeline::Calibration::identity(plan().samples);
    calibration.positions = loop->spectrometer().true_k_positions();
    calibration.dispersion_rad = loop->spectrometer().true_dispersion_rad();
    auto made = tests::must(
        pipeline::Reconstructor::create({.calibration = calibration,
                                         .format = pipeline::SpectrumFormat{loop->format()},
                                         .a_scans = plan().converted_lines()}));
    auto workspace = made.make_workspace();
    for (std::uint64_t volume = 0; volume < 2; ++volume) {
      for (int sweep = 0; sweep < plan().sweeps(); ++sweep)
        made.reconstruct_b_scan(workspace, loop->frame(volume, sweep),
                                sweeps.emplace_back(made.levels()));
    }
  }

  // What the pipeline does with two volumes.
  double find_offset() {
    pipeline::ScanLagEstimator estimator{plan()};
    pipeline::ScanLagTracker tracker{0};
    for (int volume = 0; volume < 2; ++volume) {
      pipeline::DownsampledSweep sketch{plan()};
      for (int sweep = 0; sweep < plan().sweeps(); ++sweep)
        sketch.draw(sweep, sweeps[static_cast<std::size_t>(volume * plan().sweeps() + sweep)]);
      const auto estimate = estimator.estimate(sketch);
      EXPECT_TRUE(estimate.convincing()) << estimate.correlation << " " << estimate.significance
                                         << " " << estimate.disagreement_a_scans;
      tracker.update(estimate);
    }
    EXPECT_TRUE(tracker.found());
    return tracker.in_use_a_scans();
  }

  // Where the mirror was, between two lines if need be, when the levels of A-scan a were taken.
  double true_place(int sweep, const SweepAlignment& alignment, int a) const {
    const bool backwards = plan().runs_backwards(sweep);
    const double line = alignment.first_line(backwards) + (backwards ? plan().a_scans - 1 - a : a);
    const double whole = std::floor(line);
    const auto at = [&](double l) {
      return loop->beam_path().a_scan_at(sweep, static_cast<int>(l));
    };
    return at(whole) + (line - whole) * (at(whole + 1) - at(whole));
  }

  // By how many A-scans the odd sweeps lie off the even ones beside them, from the levels alone:
  // the least-squares shift of one smoothed picture onto the other.
  double displacement(const SweepAlignment& alignment) const {
    double products = 0;
    double squares = 0;
    const int last_sweep = plan().sweeps() - 1;
    for (int sweep = 1; sweep < last_sweep; sweep += 2) {
      const auto before = smoothed(sweep - 1, alignment);
      const auto here = smoothed(sweep, alignment);
      const auto after = smoothed(sweep + 1, alignment);
      const auto depths = static_cast<std::size_t>(plan().geometry().depths);
      for (std::size_t i = 20 * depths; i < before.size() - 20 * depths; ++i) {
        const double slope =
            (before[i + depths] + after[i + depths] - before[i - depths] - after[i - depths]) / 4;
        products += slope * ((before[i] + after[i]) / 2 - here[i]);
        squares += slope * slope;
      }
    }
    return products / squares;
  }

  std::vector<double> smoothed(int sweep, const SweepAlignment& alignment) const {
    const auto depths = static_cast<std::size_t>(plan().geometry().depths);
    std::vector<std::uint8_t> levels(static_cast<std::size_t>(plan().a_scans) * depths);
    alignment.apply(sweeps[static_cast<std::size_t>(sweep)], plan().runs_backwards(sweep), levels);
    std::vector<double> smooth(levels.size());
    constexpr int width = 7;
    for (int a = width; a < plan().a_scans - width; ++a) {
      for (std::size_t z = 4; z + 4 < depths; ++z) {
        double sum = 0;
        double weights = 0;
        for (int d = -width; d <= width; ++d) {
          const double weight = std::exp(-0.5 * d * d / 9.0);
          const std::size_t at = static_cast<std::size_t>(a + d) * depths + z;
          for (std::size_t dz = 0; dz < 5; ++dz)
            sum += weight * levels[at + dz - 2];
          weights += 5 * weight;
        }
        smooth[static_cast<std::size_t>(a) * depths + z] = sum / weights;
      }
    }
    return smooth;
  }

  std::unique_ptr<sim::VolumeLoop> loop;
  std::vector<std::vector<std::uint8_t>> sweeps; // [volume][sweep], of lines as they came
};

TEST_P(BidirectionalTwin, neighbouring_sweeps_agree_within_a_quarter_of_an_a_scan) {
  const double found = find_offset();
  const double lag = loop->beam_path().lag_lines();
  const SweepAlignment alignment{plan(), found};
  EXPECT_EQ(alignment.repeated_a_scans(), 0);
  double worst = 0;
  for (int sweep = 1; sweep < plan().sweeps() - 1; sweep += 2) {
    for (int a = 0; a < plan().a_scans; ++a) {
      const double here = true_place(sweep, alignment, a);
      for (const int neighbour : {sweep - 1, sweep + 1})
        worst = std::max(worst, std::abs(here - true_place(neighbour, alignment, a)));
    }
  }
  std::printf("%s: lag %.3f A-scans, found %.3f; neighbours differ by %.3f at most\n",
              GetParam().phantom.c_str(), lag, found, worst);
  EXPECT_LE(worst, 0.25);
}

TEST_P(BidirectionalTwin, the_picture_shows_no_comb) {
  const double found = find_offset();
  const double residual = displacement(SweepAlignment{plan(), found});
  const double off_by_half = displacement(SweepAlignment{plan(), found + 0.5});
  std::printf("%s: residual %.3f A-scans, %.3f with an offset half an A-scan wrong\n",
              GetParam().phantom.c_str(), residual, off_by_half);
  EXPECT_LE(std::abs(residual), 0.25);
  // Noise in the slopes makes the measure timid, not blind: by a whole A-scan the sweeps differ.
  EXPECT_GE(off_by_half - residual, 0.25);
}

INSTANTIATE_TEST_SUITE_P(Phantoms, BidirectionalTwin,
                         testing::Values(Twin{"anterior_eye", 5.375, 1},
                                         Twin{"anterior_eye", 0.2, 1},
                                         Twin{"anterior_eye", 9.77, 2}, Twin{"nail_fold", 7.13, 1},
                                         Twin{"cap", 2.6, 1}, Twin{"cap", 2.6, 3}),
                         [](const auto& test) {
                           return test.param.phantom + "_" +
                                  std::to_string(std::lround(test.param.lag_a_scans * 1000)) +
                                  "_x" + std::to_string(test.param.repeats);
                         });

// The patient holds nothing that could be seen: the offset stays what it was.
TEST(BidirectionalTwinInTheDark, an_empty_field_moves_nothing) {
  ScanPlan plan;
  plan.samples = 128;
  plan.a_scans = 120;
  plan.b_scans = 30;
  plan.bidirectional = true;
  pipeline::ScanLagEstimator estimator{plan};
  pipeline::ScanLagTracker tracker{3};
  const auto spectrometer = tests::must(sim::Spectrometer::make({.samples = 128}));
  const sim::SpectrumSynthesis synthesis{spectrometer};
  auto workspace = synthesis.make_workspace();
  auto calibration = pipeline::Calibration::identity(128);
  const hal::LineFormat format{.samples_per_line = 128, .lines_per_frame = plan.lines_per_frame()};
  auto reconstructor =
      tests::must(pipeline::Reconstructor::create({.calibration = calibration,
                                                   .format = pipeline::SpectrumFormat{format},
                                                   .a_scans = plan.converted_lines()}));
  auto buffers = reconstructor.make_workspace();
  std::vector<float> mean(128);
  const std::vector<std::complex<float>> nothing(64);
  synthesis.mean_counts(nothing, {}, workspace, mean);
  std::vector<std::uint16_t> frame(static_cast<std::size_t>(plan.lines_per_frame()) * 128);
  std::vector<std::uint8_t> levels(reconstructor.levels());
  std::uint64_t key = 0;
  for (int volume = 0; volume < 6; ++volume) {
    pipeline::DownsampledSweep sketch{plan};
    for (int sweep = 0; sweep < plan.sweeps(); ++sweep) {
      for (std::size_t line = 0; line < frame.size(); line += 128)
        synthesis.expose(mean, ++key * 0x9e3779b97f4a7c15U, std::span{frame}.subspan(line, 128));
      reconstructor.reconstruct_b_scan(buffers, std::as_bytes(std::span{frame}), levels);
      sketch.draw(sweep, levels);
    }
    tracker.update(estimator.estimate(sketch));
  }
  EXPECT_EQ(tracker.in_use_a_scans(), 3);
  EXPECT_EQ(tracker.refused(), 6U);
}

} // namespace
} // namespace octascope
