// Blood that flows, and tissue that moves, between the repeats of a B-scan.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <complex>
#include <cstdlib>
#include <memory>
#include <numbers>
#include <span>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "sim/phantoms/flow_truth.h"
#include "sim/phantoms/phantom_perfused.h"
#include "sim/phantoms/phantom_profile.h"
#include "sim/phantoms/scatterer_motion.h"
#include "sim/spectra/repeated_sweeps.h"
#include "tests/sim/loop_lines.h"
#include "tests/support/fails_with.h"

namespace octascope::sim {
namespace {

constexpr std::array<double, 4> times_s{0, 0.0018, 0.0031, 0.0054};

TEST(ScattererMotion, repeats_correlate_by_the_formula) {
  for (const ScattererMotion& motion :
       {ScattererMotion{0, 0, 1}, ScattererMotion{2, 0, 1}, ScattererMotion{1, 0.1F, 1},
        ScattererMotion{3, -0.4F, 0.3F}, ScattererMotion{40, 5, 1}}) {
    std::array<std::array<std::complex<float>, most_repeats>, most_repeats> rows;
    for (std::size_t i = 0; i < 4; ++i)
      rows[i] = repeat_weights(motion, std::span{times_s}.first(i + 1));
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = 0; j <= i; ++j) {
        std::complex<float> found = 0;
        for (std::size_t k = 0; k < 4; ++k)
          found += rows[i][k] * std::conj(rows[j][k]);
        const auto expected = field_correlation(motion, times_s[i] - times_s[j]);
        EXPECT_NEAR(std::abs(std::complex<double>{found} - expected), 0, 1e-4) << i << ", " << j;
      }
    }
  }
}

TEST(ScattererMotion, falls_to_one_part_in_e_after_a_cell_and_turns_by_the_way_along_the_beam) {
  const double cell_s = lateral_cell_um * 1e-3 / 2;
  EXPECT_NEAR(std::abs(field_correlation({2, 0, 1}, cell_s)), std::exp(-1), 1e-6);
  EXPECT_NEAR(std::arg(field_correlation({0, 0.01F, 1}, 0.002)), phase_rad_per_mm * 0.01 * 0.002,
              1e-6);
  EXPECT_NEAR(field_correlation({1e3F, 0, 0.25F}, 1).real(), 0.75, 1e-6) << "what is still";
}

// One wide vessel in tissue.
class LumenInTissue : public testing::Test {
protected:
  static constexpr float axis_mm = 0.7F;
  static constexpr float radius_mm = 0.1F;
  static constexpr float across_mm_per_s = 2.5F;
  static constexpr float along_mm_per_s = 0.01F;

  LumenInTissue() {
    column_.add(Layer{0.3F, 20, 9});
    Layer lumen{axis_mm - radius_mm, axis_mm + radius_mm, 12};
    lumen.flowing = true;
    lumen.flow = {axis_mm, 0, radius_mm, across_mm_per_s, along_mm_per_s};
    column_.add(lumen);
  }

  static Visit visit(int repeat, std::uint64_t group = 40) {
    return {group + static_cast<std::uint64_t>(repeat), repeat, 4, times_s};
  }

  // Between two repeats, over the bins from one depth to before another, of many places.
  std::complex<double> correlation(int first, int second, int from, int to) {
    Correlation sum;
    for (int place = 0; place < 400; ++place) {
      const float x_mm = 0.02F * static_cast<float>(place);
      maker_.fill(profile_, column_, x_mm, 0, visit(first));
      maker_.fill(later_, column_, x_mm, 0, visit(second));
      for (auto d = static_cast<std::size_t>(from); d < static_cast<std::size_t>(to); ++d)
        sum.add(later_.scatterers[d], profile_.scatterers[d]);
    }
    return sum.complex_value();
  }

  static int bin(float depth_mm) { return static_cast<int>(depth_mm / 0.0035F + 0.5F); }

  Column column_;
  ProfileMaker maker_{pipeline::ScanPlan{}.geometry(), 1};
  ProfileMaker::Profile profile_ = maker_.make_profile();
  ProfileMaker::Profile later_ = maker_.make_profile();
};

TEST_F(LumenInTissue, tissue_above_it_is_the_same_in_each_repeat) {
  maker_.fill(profile_, column_, 0.3F, 0, visit(0));
  for (const int repeat : {1, 2, 3}) {
    maker_.fill(later_, column_, 0.3F, 0, visit(repeat));
    for (auto d = 0; d < bin(axis_mm - radius_mm) - 1; ++d)
      ASSERT_EQ(profile_.scatterers[static_cast<std::size_t>(d)],
                later_.scatterers[static_cast<std::size_t>(d)]);
  }
}

TEST_F(LumenInTissue, decorrelates_with_time_as_its_speed_there_says) {
  for (const float part : {0.0F, 0.5F, 0.8F}) { // of the radius
    const int middle = bin(axis_mm + part * radius_mm);
    const float speed = 1 - part * part;
    double before = 1;
    for (const int repeat : {1, 2, 3}) {
      const auto found = correlation(0, repeat, middle - 1, middle + 2);
      const auto expected = field_correlation({across_mm_per_s * speed, along_mm_per_s * speed, 1},
                                              times_s[static_cast<std::size_t>(repeat)]);
      EXPECT_NEAR(std::abs(found - expected), 0, 0.06)
          << "at " << part << " of the radius, repeat " << repeat;
      EXPECT_LT(std::abs(found), before);
      before = std::abs(found) + 0.06;
    }
  }
}

TEST_F(LumenInTissue, is_faster_in_the_middle_than_at_the_wall) {
  const int reach = bin(radius_mm);
  double before = 0;
  for (const float part : {0.0F, 0.4F, 0.7F, 0.9F}) {
    const int from = bin(axis_mm) + static_cast<int>(part * static_cast<float>(reach));
    const double found = std::abs(correlation(0, 1, from - 1, from + 2));
    EXPECT_GT(found, before + 0.02);
    before = found;
  }
}

TEST_F(LumenInTissue, correlates_from_any_repeat_to_any_other) {
  const int middle = bin(axis_mm);
  const auto expected =
      field_correlation({across_mm_per_s, along_mm_per_s, 1}, times_s[2] - times_s[1]);
  EXPECT_NEAR(std::abs(correlation(1, 2, middle - 1, middle + 2) - expected), 0, 0.06);
}

TEST_F(LumenInTissue, takes_some_of_the_light_below_it_along) {
  const int below = bin(axis_mm + radius_mm) + 4;
  const double share = 1 - std::exp(-tail_per_mm * 2 * double{radius_mm});
  const auto expected = field_correlation(
      {across_mm_per_s / 2, along_mm_per_s / 2, static_cast<float>(share)}, times_s[3]);
  EXPECT_NEAR(std::abs(correlation(0, 3, below, below + 40) - expected), 0, 0.06);
  EXPECT_LT(std::abs(expected), 0.9);
}

VolumeLoopConfig few_b_scans(int repeats) {
  VolumeLoopConfig config = *suggested_loop("perfused");
  config.volumes = 1;
  config.plan.b_scans = 4;
  config.plan.b_spacing_um = 600;
  config.plan.fly_back_lines = 79;
  config.plan.repeats = repeats;
  return config;
}

VolumeLoopConfig without_noise(VolumeLoopConfig config) {
  config.spectrometer.electrons_per_count = 1e9;
  config.spectrometer.read_noise_counts = 0;
  return config;
}

std::unique_ptr<VolumeLoop> make(const VolumeLoopConfig& config) {
  auto loop = VolumeLoop::make(config);
  EXPECT_TRUE(loop);
  return std::move(*loop);
}

int greatest_difference(std::span<const std::uint16_t> one, std::span<const std::uint16_t> other) {
  int greatest = 0;
  for (std::size_t p = 0; p < one.size(); ++p)
    greatest = std::max(greatest, std::abs(int{one[p]} - int{other[p]}));
  return greatest;
}

TEST(RepeatedSweeps, tissue_without_noise_is_the_same_and_blood_is_not) {
  const VolumeLoopConfig config = without_noise(few_b_scans(2));
  const auto loop = make(config);
  const auto truth = flow_truth(loop->phantom(), config.plan.geometry());
  int still = 0;
  int flowing = 0;
  for (int b = 0; b < config.plan.b_scans; ++b) {
    for (int a = 0; a < config.plan.a_scans; ++a) {
      const auto column = std::span{truth}.subspan(
          static_cast<std::size_t>(b * config.plan.a_scans + a) * 512, 512);
      const int difference =
          greatest_difference(line_of(*loop, 0, 2 * b, a), line_of(*loop, 0, 2 * b + 1, a));
      if (std::ranges::max(column) == 0) {
        EXPECT_LE(difference, 1); // what little noise there is may round to the next count
        ++still;
      } else if (std::ranges::count(column, 1.0F) > 5) {
        EXPECT_GT(difference, 4);
        ++flowing;
      }
    }
  }
  EXPECT_GT(still, 100);
  EXPECT_GT(flowing, 100);
}

TEST(RepeatedSweeps, a_beam_that_goes_there_and_back_returns_sooner_at_one_end) {
  VolumeLoopConfig config = without_noise(few_b_scans(2));
  config.plan.bidirectional = true;
  config.galvo_lag_us = 0;
  config.plan.line_rate_hz = 2e6; // so fast that something is left of the slow end's speckle
  const auto loop = make(config);
  const auto truth = flow_truth(loop->phantom(), config.plan.geometry());
  // Decorrelation of intensities, 1/2 where nothing is left of them: phases differ from vessel to
  // vessel. Where the beam turns, and where it began.
  struct End {
    double product = 0;
    double squares = 0;
    int count = 0;
    double decorrelation() const { return 1 - 2 * product / squares; }
  };
  std::array<End, 2> ends;
  for (int b = 0; b < config.plan.b_scans; ++b) {
    for (int a = 0; a < config.plan.a_scans; a += 3) {
      if (a >= 60 && a < 240)
        continue;
      const auto column = std::span{truth}.subspan(
          static_cast<std::size_t>(b * config.plan.a_scans + a) * 512, 512);
      if (std::ranges::count(column, 1.0F) < 4)
        continue;
      const auto there = a_scan(*loop, 0, 2 * b, a);
      const auto back = a_scan(*loop, 0, 2 * b + 1, config.plan.a_scans - 1 - a);
      for (std::size_t d = 0; d < 512; ++d) {
        if (column[d] < 1)
          continue;
        End& end = ends[a < 60 ? 1 : 0];
        const double first = std::norm(there[d]);
        const double second = std::norm(back[d]);
        end.product += first * second;
        end.squares += first * first + second * second;
        ++end.count;
      }
    }
  }
  EXPECT_GT(ends[0].count, 100);
  EXPECT_GT(ends[1].count, 100);
  EXPECT_LT(ends[0].decorrelation(), ends[1].decorrelation() - 0.1);
}

TEST(RepeatedSweeps, are_the_same_whichever_thread_makes_them) {
  VolumeLoopConfig config = few_b_scans(3);
  config.plan.b_scans = 2;
  config.volumes = 2; // the second is made by another thread
  config.motion.axial = {{5, 40}};
  const auto first = make(config);
  const auto again = make(config);
  while (first->ready_volumes() < 2 || again->ready_volumes() < 2)
    std::this_thread::sleep_for(std::chrono::milliseconds{1});
  for (const std::uint64_t volume : {0U, 1U})
    for (int sweep = 0; sweep < first->sweeps(); ++sweep)
      EXPECT_TRUE(std::ranges::equal(first->frame(volume, sweep), again->frame(volume, sweep)));
}

TEST(RepeatedSweeps, come_with_their_truth) {
  const VolumeLoopConfig config = few_b_scans(2);
  const auto made = simulate_repeats(config);
  ASSERT_TRUE(made) << made.error().message;
  const auto loop = make(config);
  EXPECT_EQ(made->plan().sweeps(), 8);
  for (int sweep = 0; sweep < 8; ++sweep) {
    const auto lines = made->sweep(sweep);
    ASSERT_EQ(lines.size(), 300U * 1024);
    EXPECT_TRUE(std::ranges::equal(lines.last(1024), line_of(*loop, 0, sweep, 299)));
  }
  EXPECT_EQ(made->flow, flow_truth(loop->phantom(), config.plan.geometry()));
  EXPECT_GT(made->tree.tree.nodes(), 1000U);
  VolumeLoopConfig there_and_back = config;
  there_and_back.plan.bidirectional = true;
  EXPECT_THAT(simulate_repeats(there_and_back), tests::FailsSaying("bidirectional"));
}

// A second tone of no frequency is a constant displacement.
std::vector<MotionTone> constant(double um) {
  return {{0, 0}, {um / std::sin(2.4), 0}};
}

TEST(MovingTissue, is_a_sum_of_sines) {
  const TissueMotion motion{.axial = {{8, 2}, {3, 10}}, .lateral = constant(10)};
  EXPECT_DOUBLE_EQ(motion.axial_um(0.01), 8 * std::sin(0.04 * std::numbers::pi) +
                                              3 * std::sin(0.2 * std::numbers::pi + 2.4));
  EXPECT_DOUBLE_EQ(motion.lateral_um(7), 10);
  EXPECT_THAT((TissueMotion{.axial = {{-1, 2}}, .lateral = {}}).validate(),
              tests::FailsSaying("-1", "200"));
}

// The phase is that of the line's middle, and A-scans are read out from its beginning.
double off_expected_rad(double turned_rad, double deeper_um) {
  const double expected = phase_rad_per_mm * deeper_um * 1e-3 -
                          std::numbers::pi * deeper_um / pipeline::ScanPlan{}.depth_spacing_um;
  return std::remainder(turned_rad - expected, 2 * std::numbers::pi);
}

TEST(MovingTissue, shifts_by_parts_of_a_bin_with_its_phase) {
  VolumeLoopConfig config = without_noise(few_b_scans(1));
  const auto still = make(config);
  constexpr double deeper_um = 10.3;
  config.motion.axial = constant(deeper_um);
  const auto moved = make(config);
  Correlation same;
  Correlation unmoved;
  for (const int a : {40, 120, 200, 280}) {
    const auto before = a_scan(*still, 0, 1, a);
    const auto after = a_scan(*moved, 0, 1, a, deeper_um / config.plan.depth_spacing_um);
    const auto here = a_scan(*moved, 0, 1, a);
    for (std::size_t d = 60; d < 400; ++d) {
      same.add(after[d], before[d]);
      unmoved.add(here[d], before[d]);
    }
  }
  EXPECT_GT(same.value(), 0.995);
  EXPECT_LT(unmoved.value(), 0.3);
  EXPECT_NEAR(off_expected_rad(std::arg(same.complex_value()), deeper_um), 0, 0.05);
}

TEST(MovingTissue, shifts_along_the_b_scan) {
  VolumeLoopConfig config = without_noise(few_b_scans(1));
  const auto still = make(config);
  config.motion.lateral = constant(3 * config.plan.a_spacing_um);
  const auto moved = make(config);
  for (const int a : {10, 100, 290}) {
    Correlation same;
    Correlation unmoved;
    const auto before = a_scan(*still, 0, 1, a - 3);
    const auto after = a_scan(*moved, 0, 1, a);
    const auto here = a_scan(*still, 0, 1, a);
    for (std::size_t d = 60; d < 400; ++d) {
      same.add(after[d], before[d]);
      unmoved.add(after[d], here[d]);
    }
    EXPECT_GT(same.value(), 0.9);
    EXPECT_LT(unmoved.value(), 0.5);
  }
}

TEST(MovingTissue, moves_between_repeats_by_what_the_time_between_them_says) {
  VolumeLoopConfig config = without_noise(few_b_scans(2));
  config.motion.axial = {{10, 5}};
  const auto loop = make(config);
  const int a = 150;
  for (int b = 0; b < config.plan.b_scans; ++b) {
    const auto t_s = [&](int sweep) {
      return (sweep * config.plan.lines_per_frame() + a) / config.plan.line_rate_hz;
    };
    const double step_um =
        config.motion.axial_um(t_s(2 * b + 1)) - config.motion.axial_um(t_s(2 * b));
    Correlation turned;
    const auto first = a_scan(*loop, 0, 2 * b, a);
    const auto second = a_scan(*loop, 0, 2 * b + 1, a, step_um / config.plan.depth_spacing_um);
    for (std::size_t d = 60; d < 400; ++d)
      turned.add(second[d], first[d]);
    EXPECT_NEAR(off_expected_rad(std::arg(turned.complex_value()), step_um), 0, 0.3);
  }
}

double distance_mm(const VesselSegment& s, const std::array<float, 3>& at) {
  const std::array<double, 3> way{double{s.to.x_mm} - double{s.from.x_mm},
                                  double{s.to.y_mm} - double{s.from.y_mm},
                                  double{s.to.depth_mm} - double{s.from.depth_mm}};
  const std::array<double, 3> off{double{at[0]} - double{s.from.x_mm},
                                  double{at[1]} - double{s.from.y_mm},
                                  double{at[2]} - double{s.from.depth_mm}};
  const double length = way[0] * way[0] + way[1] * way[1] + way[2] * way[2];
  const double t = std::clamp(
      (way[0] * off[0] + way[1] * off[1] + way[2] * off[2]) / std::max(length, 1e-12), 0.0, 1.0);
  return std::hypot(off[0] - t * way[0], off[1] - t * way[1], off[2] - t * way[2]);
}

TEST(FlowTruth, lies_within_the_vessels_and_fills_them) {
  const PerfusedTissue tissue{1};
  pipeline::VolumeGeometry geometry = tissue.suggested_plan().geometry();
  const auto truth = flow_truth(tissue, geometry);
  ASSERT_EQ(truth.size(), geometry.voxels());
  const auto segments = tissue.vessels();
  std::size_t flowing = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    ASSERT_GE(truth[i], 0);
    ASSERT_LE(truth[i], 1);
    if (truth[i] < 1 || ++flowing % 301 != 0)
      continue;
    const auto d = static_cast<int>(i % 512);
    const auto a = static_cast<int>(i / 512 % 300);
    const auto b = static_cast<int>(i / 512 / 300);
    const std::array<float, 3> at{static_cast<float>((a - 149.5) * 0.01),
                                  static_cast<float>((b - 39.5) * 0.0375),
                                  static_cast<float>(d * 0.0035)};
    EXPECT_TRUE(std::ranges::any_of(
        segments,
        [&](const VesselSegment& s) { return distance_mm(s, at) < double{s.radius_mm} + 0.002; }))
        << at[0] << ", " << at[1] << ", " << at[2];
  }
  EXPECT_GT(flowing, 40000U);
  EXPECT_LT(flowing, truth.size() / 20);
  int tried = 0;
  for (const VesselSegment& s : segments) {
    const double a = double{s.from.x_mm} / 0.01 + 149.5;
    const double b = double{s.from.y_mm} / 0.0375 + 39.5;
    if (s.radius_mm < 0.024F || a < 0 || a > 299 || b < 0 || b > 79)
      continue;
    const auto column = static_cast<std::size_t>(std::lround(b) * 300 + std::lround(a));
    EXPECT_GT(truth[column * 512 +
                    static_cast<std::size_t>(std::lround(double{s.from.depth_mm} / 0.0035))],
              0);
    ++tried;
  }
  EXPECT_GT(tried, 20);
}

TEST(PerfusedTissue, branches_from_eight_a_scans_wide_to_less_than_one) {
  const PerfusedTissue tissue{1};
  const auto segments = tissue.vessels();
  const auto [thinnest, widest] =
      std::ranges::minmax_element(segments, {}, &VesselSegment::radius_mm);
  EXPECT_EQ(widest->radius_mm, 0.04F);
  EXPECT_LT(thinnest->radius_mm, 0.005F);
  EXPECT_GE(thinnest->radius_mm, PerfusedTissue::capillary_mm);
}

TEST(PerfusedTissue, is_about_25_db_above_the_noise_and_falls_with_depth) {
  const VolumeLoopConfig config = few_b_scans(2);
  const auto loop = make(config);
  const auto truth = flow_truth(loop->phantom(), config.plan.geometry());
  std::array<double, 3> signal{}; // 0.05, 0.4 and 0.8 mm below the surface
  std::array<double, 3> noise{};
  for (int a = 0; a < config.plan.a_scans; a += 6) {
    const auto column = std::span{truth}.subspan(static_cast<std::size_t>(300 + a) * 512, 512);
    if (std::ranges::max(column) > 0)
      continue;
    const auto first = a_scan(*loop, 0, 2, a);
    const auto second = a_scan(*loop, 0, 3, a);
    const float top =
        dynamic_cast<const PerfusedTissue&>(loop->phantom())
            .top_mm(static_cast<float>((a - 149.5) * 0.01), static_cast<float>(-0.5 * 0.6));
    for (std::size_t i = 0; i < 3; ++i) {
      const std::array below_mm{0.05F, 0.4F, 0.8F};
      const auto from = static_cast<std::size_t>((top + below_mm[i]) / 0.0035F);
      for (std::size_t d = from; d < from + 20; ++d) {
        noise[i] += std::norm(first[d] - second[d]) / 2;
        signal[i] += std::norm(first[d]);
      }
    }
  }
  std::array<double, 3> ratio_db{};
  for (std::size_t i = 0; i < 3; ++i) {
    ratio_db[i] = 10 * std::log10(signal[i] / noise[i] - 1);
    RecordProperty("ratio_db_" + std::to_string(i), std::to_string(ratio_db[i]));
  }
  EXPECT_NEAR(ratio_db[0], 25, 2);
  EXPECT_LT(ratio_db[1], ratio_db[0] - 1.5);
  EXPECT_LT(ratio_db[2], ratio_db[1] - 1.5);
  EXPECT_GT(ratio_db[2], 8);
}

} // namespace
} // namespace octascope::sim
