#include <algorithm>
#include <cmath>
#include <complex>
#include <random>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "pipeline/angiography/b_scan_flow.h"
#include "tests/pipeline/angiography/flow_figures.h"
#include "tests/pipeline/angiography/speckle_scene.h"
#include "tests/support/allocation_counter.h"
#include "tests/support/files/fresh_seed.h"
#include "tests/support/must.h"

namespace octascope::pipeline {
namespace {

using Bins = std::vector<PackedBin>;
using tests::SpeckleScene;
using tests::SpeckleSweeps;

struct Result {
  std::vector<float> flow;
  std::vector<float> decorrelation;
  FlowOutcome outcome;
};

Result compute(BScanFlow& computer, const Bins& bins) {
  Result result{std::vector<float>(computer.voxels()), std::vector<float>(computer.voxels()), {}};
  result.outcome = computer.compute(bins, result.flow, result.decorrelation);
  return result;
}

Result compute(const FlowSetup& setup, const Bins& bins) {
  auto computer = tests::must(BScanFlow::create(setup));
  return compute(computer, bins);
}

FlowSetup setup_of(const SpeckleScene& scene, FlowMethod method = FlowMethod::complex_bins) {
  return {scene.repeats, scene.a_scans, scene.depths, method};
}

// By the definition in the header, in double precision, without motion.
std::vector<double> exact_decorrelation(const FlowSetup& s, const Bins& bins) {
  const auto bin = [&](int m, int a, int z) {
    const auto at =
        static_cast<std::size_t>(m * s.a_scans + a) * static_cast<std::size_t>(s.depths);
    return std::complex<double>{bins[at + static_cast<std::size_t>(z)].value()};
  };
  const auto turn = [&](int m, int a) {
    std::complex<double> sum;
    for (int z = 0; z < s.depths; ++z)
      sum += bin(m, a, z) * std::conj(bin(m + 1, a, z));
    return std::polar(1.0, -std::arg(sum));
  };
  std::vector<double> result;
  for (int a = 0; a < s.a_scans; ++a)
    for (int z = 0; z < s.depths; ++z) {
      std::complex<double> like;
      double power = 0;
      for (int m = 0; m + 1 < s.repeats; ++m)
        for (int i = std::max(0, a - 1); i <= std::min(s.a_scans - 1, a + 1); ++i)
          for (int k = std::max(0, z - 2); k <= std::min(s.depths - 1, z + 2); ++k) {
            const auto one = bin(m, i, k);
            const auto two = bin(m + 1, i, k);
            if (s.method == FlowMethod::intensity) {
              like += std::norm(one) * std::norm(two);
              power += (std::norm(one) * std::norm(one) + std::norm(two) * std::norm(two)) / 2;
            } else {
              like += one * std::conj(two) * turn(m, i);
              power += (std::norm(one) + std::norm(two)) / 2;
            }
          }
      result.push_back(1 - std::abs(like) / power);
    }
  return result;
}

TEST(BScanFlow, decorrelation_is_that_of_its_definition) {
  std::mt19937 generator{tests::fresh_seed()};
  std::normal_distribution<float> normal;
  for (const auto method : {FlowMethod::complex_bins, FlowMethod::intensity})
    for (const int repeats : {2, 3, 4})
      for (const auto& [a_scans, depths] : {std::pair{1, 7}, {2, 1}, {3, 4}, {9, 40}, {20, 67}}) {
        const FlowSetup setup{repeats, a_scans, depths, method};
        const auto voxels = static_cast<std::size_t>(a_scans * depths);
        Bins bins(voxels * static_cast<std::size_t>(repeats));
        for (std::size_t i = 0; i < bins.size(); ++i) {
          const std::complex<float> change{normal(generator), normal(generator)};
          bins[i] = PackedBin::of(i < voxels ? 100.0F * change
                                             : bins[i - voxels].value() + 60.0F * change);
        }
        const auto found = compute(setup, bins).decorrelation;
        const auto expected = exact_decorrelation(setup, bins);
        for (std::size_t i = 0; i < voxels; ++i)
          ASSERT_NEAR(found[i], expected[i], 2e-5)
              << repeats << " repeats of " << a_scans << " x " << depths << ", voxel " << i;
      }
}

struct Motion {
  const char* name;
  std::vector<double> axial;
  std::vector<double> lateral;
};
void PrintTo(const Motion& motion, std::ostream* out) {
  *out << motion.name;
}

SpeckleScene scene_with(const Motion& motion, int repeats) {
  SpeckleScene scene;
  scene.repeats = repeats;
  scene.axial_shifts = motion.axial;
  scene.lateral_shifts = motion.lateral;
  return scene;
}

// 3.5 µm a depth: 10 µm are 2.9 of them.
class MovingSample : public testing::TestWithParam<Motion> {};
INSTANTIATE_TEST_SUITE_P(
    Motions, MovingSample,
    testing::Values(Motion{"still", {0, 0, 0, 0}, {0, 0, 0, 0}},
                    Motion{"ten_micrometres", {0, 2.9, 0.3, -2.6}, {0, 0, 0, 0}},
                    Motion{"half_a_bin", {0, 0.5, 1.0, 1.5}, {0, 0, 0, 0}},
                    Motion{"an_a_scan", {0, 6.3, 1.1, 2}, {0, 1, 2, 1}},
                    Motion{"part_of_an_a_scan", {0, 2.6, 1.1, -2.7}, {0, 0.4, 0.8, 0.2}}),
    [](const auto& info) { return std::string{info.param.name}; });

struct FiguresByMethod {
  tests::FlowFigures complex_bins;
  tests::FlowFigures intensity;
};

// The mean of B-scans with other speckle: one has too few speckles to tell a method by.
FiguresByMethod mean_figures(const SpeckleScene& scene) {
  constexpr unsigned b_scans = 4;
  const unsigned seed = tests::fresh_seed();
  std::vector<tests::FlowFigures> of_bins, of_intensity;
  for (unsigned i = 0; i < b_scans; ++i) {
    const Bins bins = SpeckleSweeps{scene, seed + i}.bins();
    const auto figures = [&](FlowMethod method) {
      const auto result = compute(setup_of(scene, method), bins);
      EXPECT_FALSE(result.outcome.left_out);
      return tests::flow_figures(scene, result.flow);
    };
    of_bins.push_back(figures(FlowMethod::complex_bins));
    of_intensity.push_back(figures(FlowMethod::intensity));
  }
  return {tests::mean_of(of_bins), tests::mean_of(of_intensity)};
}

TEST_P(MovingSample, vessels_are_told_from_static_tissue) {
  for (const int repeats : {2, 3, 4}) {
    SpeckleScene scene = scene_with(GetParam(), repeats);
    scene.tubes = {{20, 60, 3, 8},   {48, 80, 5, 14},  {75, 110, 2, 5.7},
                   {30, 130, 4, 11}, {60, 160, 6, 17}, {80, 60, 2, 6}};
    const auto [complex_bins, intensity] = mean_figures(scene);
    EXPECT_GE(complex_bins.area, repeats == 4 ? 0.95 : 0.90) << repeats << " repeats";
    EXPECT_LE(complex_bins.false_share, 0.02) << repeats << " repeats";
    EXPECT_GE(complex_bins.told_share, 0.95) << repeats << " repeats";
    EXPECT_GE(intensity.area, repeats == 4 ? 0.90 : 0.83) << repeats << " repeats";
    EXPECT_LE(intensity.false_share, 0.03) << repeats << " repeats";
  }
}

TEST_P(MovingSample, static_tissue_is_not_called_flowing) {
  for (const double snr_db : {25, 12}) {
    SpeckleScene scene = scene_with(GetParam(), 2);
    scene.snr_db = snr_db;
    const auto [complex_bins, intensity] = mean_figures(scene);
    EXPECT_LE(complex_bins.false_share, 0.01) << snr_db << " dB";
    EXPECT_LE(intensity.false_share, 0.01) << snr_db << " dB";
  }
}

TEST_P(MovingSample, motion_is_found_to_a_twentieth_of_a_bin) {
  const SpeckleScene scene = scene_with(GetParam(), 2);
  const auto outcome =
      compute(setup_of(scene), SpeckleSweeps{scene, tests::fresh_seed()}.bins()).outcome;
  EXPECT_TRUE(outcome.largest_motion.found);
  EXPECT_NEAR(outcome.largest_motion.axial_bins, scene.axial_shifts[1], 0.05);
  EXPECT_EQ(outcome.largest_motion.lateral_a_scans, std::lround(scene.lateral_shifts[1]));
}

TEST(BScanFlow, of_noise_nothing_is_told) {
  SpeckleScene scene;
  scene.surface = scene.depths - 1; // no tissue
  const auto result = compute(setup_of(scene), SpeckleSweeps{scene, tests::fresh_seed()}.bins());
  const auto told =
      std::ranges::count_if(result.flow, [](float flow) { return !std::isnan(flow); });
  EXPECT_LE(static_cast<double>(told), 0.05 * static_cast<double>(result.flow.size()));
  EXPECT_FALSE(result.outcome.left_out);
}

bool is_left_out(const Result& result) {
  return result.outcome.left_out &&
         std::ranges::all_of(result.flow, [](float flow) { return std::isnan(flow); });
}

// One repeat of another place: the first, one between, the last.
TEST(BScanFlow, repeats_that_have_nothing_in_common_are_left_out) {
  const unsigned seed = tests::fresh_seed();
  for (const int repeats : {2, 3, 4}) {
    SpeckleScene scene;
    scene.repeats = repeats;
    const Bins bins = SpeckleSweeps{scene, seed}.bins();
    const Bins other = SpeckleSweeps{scene, seed + 1}.bins();
    for (const auto method : {FlowMethod::complex_bins, FlowMethod::intensity}) {
      EXPECT_FALSE(is_left_out(compute(setup_of(scene, method), bins)));
      for (int m = 0; m < repeats; ++m) {
        Bins jumped = bins;
        const auto at = m * static_cast<std::ptrdiff_t>(scene.voxels());
        std::copy_n(other.begin() + at, scene.voxels(), jumped.begin() + at);
        EXPECT_TRUE(is_left_out(compute(setup_of(scene, method), jumped)))
            << "repeat " << m << " of " << repeats;
      }
    }
  }
}

TEST(BScanFlow, motion_beyond_the_limit_is_left_out) {
  SpeckleScene scene;
  for (const int repeats : {2, 3, 4}) {
    scene.repeats = repeats;
    scene.axial_shifts.assign(4, 0);
    scene.axial_shifts[static_cast<std::size_t>(repeats - 1)] = 20;
    EXPECT_TRUE(
        is_left_out(compute(setup_of(scene), SpeckleSweeps{scene, tests::fresh_seed()}.bins())))
        << repeats << " repeats";
  }
}

TEST(BScanFlow, small_b_scans_that_moved_are_left_out) {
  SpeckleScene scene;
  scene.a_scans = 12;
  scene.depths = 60;
  const unsigned seed = tests::fresh_seed();
  Bins bins = SpeckleSweeps{scene, seed}.bins();
  EXPECT_FALSE(is_left_out(compute(setup_of(scene), bins)));
  const Bins other = SpeckleSweeps{scene, seed + 1}.bins();
  std::copy_n(other.begin(), scene.voxels(), bins.begin());
  EXPECT_TRUE(is_left_out(compute(setup_of(scene), bins)));
}

// Other places, so dim that no motion is measured; what is told of dim voxels alone would be flow.
TEST(BScanFlow, of_dim_tissue_nothing_is_told) {
  SpeckleScene scene;
  scene.snr_db = 1;
  scene.fall_db_per_depth = 0;
  const unsigned seed = tests::fresh_seed();
  Bins bins = SpeckleSweeps{scene, seed}.bins();
  const Bins other = SpeckleSweeps{scene, seed + 1}.bins();
  std::copy_n(other.begin(), scene.voxels(), bins.begin());
  const auto result = compute(setup_of(scene), bins);
  EXPECT_TRUE(std::ranges::all_of(result.flow, [](float flow) { return std::isnan(flow); }));
}

TEST(BScanFlow, where_there_is_no_power_nothing_is_told) {
  SpeckleScene scene;
  Bins bins = SpeckleSweeps{scene, tests::fresh_seed()}.bins();
  constexpr int empty_from = 200;
  for (std::size_t i = 0; i < scene.voxels(); ++i) {
    if (static_cast<int>(i) % scene.depths >= empty_from)
      bins[i] = {};
    bins[scene.voxels() + i] = bins[i]; // alike to the last bit: noise is 0
  }
  const auto flow = compute(setup_of(scene), bins).flow;
  EXPECT_NEAR(flow[100], 0, 1e-18);
  EXPECT_TRUE(std::isnan(flow[empty_from + 10]));
}

// The last block of depths is one depth, which repeats do not share once they moved.
TEST(BScanFlow, depths_that_repeats_do_not_share_take_no_noise_from_the_others) {
  SpeckleScene scene;
  scene.depths = 65;
  scene.surface = 32;
  for (const double shift : {8, -8}) {
    scene.axial_shifts[1] = shift;
    const auto result = compute(setup_of(scene), SpeckleSweeps{scene, tests::fresh_seed()}.bins());
    int told = 0;
    for (int a = 0; a < scene.a_scans; ++a) {
      const float* const line = &result.flow[static_cast<std::size_t>(a * scene.depths)];
      told += static_cast<int>(std::count_if(line, line + 20, [](float f) { return f >= 0; }));
      EXPECT_TRUE(std::isnan(shift > 0 ? line[64] : line[0]));
    }
    // A tenth: nearly all are told where the noise is wrong, else at most 4 % (400 seeds).
    EXPECT_LE(told, 2 * scene.a_scans) << "of 20 depths of noise, shifted by " << shift;
    EXPECT_LE(flow_figures(scene, result.flow).false_share, 0.02);
  }
}

// Whatever was computed before, and with no memory but its own.
TEST(BScanFlow, depends_on_its_bins_alone_and_allocates_nothing) {
  SpeckleScene scene;
  scene.repeats = 3;
  scene.axial_shifts = {0, 1.4, 1.4, 0};
  scene.tubes = {{48, 80, 5, 14}};
  const unsigned seed = tests::fresh_seed();
  const Bins bins = SpeckleSweeps{scene, seed}.bins();
  for (const auto method : {FlowMethod::complex_bins, FlowMethod::intensity}) {
    auto computer = tests::must(BScanFlow::create(setup_of(scene, method)));
    Result result = compute(computer, bins);
    SpeckleScene moved = scene;
    moved.lateral_shifts = {0, 1, 2, 0};
    compute(computer, SpeckleSweeps{moved, seed + 1}.bins());
    const Result fresh = result;
    const auto before = tests::allocations_of_this_thread();
    computer.compute(bins, result.flow, result.decorrelation);
    EXPECT_EQ(tests::allocations_of_this_thread(), before);
    EXPECT_TRUE(std::ranges::equal(std::as_bytes(std::span{result.flow}),
                                   std::as_bytes(std::span{fresh.flow})));
    EXPECT_EQ(result.decorrelation, fresh.decorrelation);
  }
}

TEST(BScanFlow, repeats_out_of_range_are_refused) {
  EXPECT_EQ(tests::error_of(BScanFlow::create({1, 10, 10})).message,
            "1 repeats of each B-scan, expected 2 to 4");
  EXPECT_EQ(tests::error_of(BScanFlow::create({5, 10, 10})).message,
            "5 repeats of each B-scan, expected 2 to 4");
  EXPECT_EQ(tests::error_of(BScanFlow::create({2, 0, 10})).message,
            "0 A-scans of 10 depths, expected at least one of each");
}

} // namespace
} // namespace octascope::pipeline
