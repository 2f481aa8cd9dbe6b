// The choice between the paths: measured once, then remembered.
#include <map>
#include <string>

#include <gtest/gtest.h>

#include "pipeline/reconstruction/fft_plan.h"
#include "pipeline/reconstruction/reconstructor.h"
#include "tests/support/files/calibrations.h"

namespace octascope::pipeline {
namespace {

struct Notebook final : PathMemory {
  std::optional<PathTimes> recall(std::string_view line_case) override {
    ++asked;
    const auto found = times.find(std::string{line_case});
    return found == times.end() ? std::nullopt : std::optional{found->second};
  }
  void remember(std::string_view line_case, const PathTimes& found) override {
    times[std::string{line_case}] = found;
  }
  std::map<std::string, PathTimes> times;
  int asked = 0;
};

Reconstructor make(const ReconstructionSetup& setup) {
  auto made = Reconstructor::create(setup);
  EXPECT_TRUE(made) << made.error().message;
  return std::move(*made);
}

ReconstructionSetup setup_of(Notebook& notebook) {
  ReconstructionSetup setup;
  setup.calibration = tests::chirped_calibration(256, 15);
  setup.format = SpectrumFormat{256, hal::SampleType::u16};
  setup.a_scans = 40;
  setup.memory = &notebook;
  return setup;
}

TEST(PathChoice, is_measured_once_and_then_remembered) {
  Notebook notebook;
  const auto setup = setup_of(notebook);
  const auto first = make(setup);
  if (first.path_decision().reason == PathReason::only)
    GTEST_SKIP() << "no fused kernels for this processor";
  EXPECT_EQ(first.path_decision().reason, PathReason::measured);
  ASSERT_EQ(notebook.times.size(), 1U);
  const PathTimes measured = notebook.times.begin()->second;
  EXPECT_GT(measured.fused_ns, 0);
  EXPECT_GT(measured.fftw_ns, 0);
  EXPECT_EQ(first.path() == ReconstructionPath::fused, measured.fused_ns <= measured.fftw_ns);

  const auto second = make(setup);
  EXPECT_EQ(second.path_decision().reason, PathReason::remembered);
  EXPECT_EQ(second.path_decision().times->fftw_ns, measured.fftw_ns);
  EXPECT_EQ(second.path(), first.path());
}

TEST(PathChoice, follows_what_is_remembered) {
  Notebook notebook;
  const auto setup = setup_of(notebook);
  if (make(setup).path_decision().reason == PathReason::only)
    GTEST_SKIP() << "no fused kernels for this processor";
  PathTimes& times = notebook.times.begin()->second;
  times = {100, 200};
  EXPECT_EQ(make(setup).path(), ReconstructionPath::fused);
  times = {200, 100};
  EXPECT_EQ(make(setup).path(), ReconstructionPath::fftw);
}

TEST(PathChoice, knows_one_case_of_lines_from_another) {
  Notebook notebook;
  auto setup = setup_of(notebook);
  if (make(setup).path_decision().reason == PathReason::only)
    GTEST_SKIP() << "no fused kernels for this processor";
  setup.calibration.interpolation = Interpolation::linear;
  make(setup);
  setup.calibration.dispersion_rad = tests::dispersion(256, 10, 10);
  make(setup);
  setup.format = SpectrumFormat{256, hal::SampleType::u8};
  make(setup);
  setup.format = SpectrumFormat{256, hal::SampleType::u16};
  setup.format.significant_bits = 12;
  setup.format.right_shift = 4;
  make(setup);
  EXPECT_EQ(notebook.times.size(), 5U);
}

TEST(PathChoice, asks_nobody_where_there_is_no_choice) {
  Notebook notebook;
  auto setup = setup_of(notebook);
  setup.path = ReconstructionPath::fftw;
  EXPECT_EQ(make(setup).path_decision().reason, PathReason::asked);
  setup.path = ReconstructionPath::automatic;
  setup.format = SpectrumFormat{256, hal::SampleType::f32};
  EXPECT_EQ(make(setup).path_decision().reason, PathReason::only);
  setup.format = SpectrumFormat{256, hal::SampleType::u16};
  setup.calibration.zero_padding = 2;
  EXPECT_EQ(make(setup).path_decision().reason, PathReason::only);
  EXPECT_EQ(notebook.asked, 0);
  EXPECT_TRUE(notebook.times.empty());
}

TEST(FftWisdom, comes_back_and_refuses_rubbish) {
  ASSERT_TRUE(plan_line_transform(840, true, false));
  const std::string wisdom = export_fft_wisdom();
  EXPECT_FALSE(wisdom.empty());
  EXPECT_TRUE(import_fft_wisdom(wisdom));
  EXPECT_EQ(export_fft_wisdom(), wisdom);
  EXPECT_FALSE(import_fft_wisdom("rubbish"));
  EXPECT_FALSE(import_fft_wisdom(""));
  EXPECT_EQ(export_fft_wisdom(), wisdom);
}

} // namespace
} // namespace octascope::pipeline
