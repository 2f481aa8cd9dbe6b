#include <algorithm>
#include <chrono>
#include <thread>

#include <gtest/gtest.h>

#include "sim/phantoms/phantom_anterior_eye.h"
#include "sim/spectra/volume_loop.h"
#include "tests/sim/loop_lines.h"

namespace octascope::sim {
namespace {

VolumeLoopConfig small_loop(std::string_view phantom) {
  VolumeLoopConfig config = *suggested_loop(phantom);
  const pipeline::ScanPlan suggested = config.plan;
  config.plan.samples = 256;
  config.plan.a_scans = 25;
  config.plan.fly_back_lines = 1;
  config.plan.b_scans = 7;
  config.plan.depth_spacing_um = suggested.depth_spacing_um * 4;
  config.plan.a_spacing_um = suggested.a_spacing_um * 12;
  config.plan.b_spacing_um = suggested.b_spacing_um * 11;
  config.volumes = 3;
  return config;
}

std::unique_ptr<VolumeLoop> complete_loop(const VolumeLoopConfig& config) {
  auto loop = VolumeLoop::make(config);
  EXPECT_TRUE(loop);
  while ((*loop)->ready_volumes() < config.volumes)
    std::this_thread::sleep_for(std::chrono::milliseconds{1});
  return std::move(*loop);
}

TEST(VolumeLoop, comes_round_and_differs_from_volume_to_volume) {
  const auto loop = complete_loop(small_loop("anterior_eye"));
  for (int b = 0; b < 7; ++b) {
    const auto frame = loop->frame(1, b);
    ASSERT_EQ(frame.size(), 256U * 26 * 2);
    EXPECT_TRUE(std::ranges::equal(frame, loop->frame(4, b)));
    EXPECT_FALSE(std::ranges::equal(frame, loop->frame(2, b)));
  }
  EXPECT_EQ(loop->description(), "front of the eye, loop of 3 volumes, 0.00 s");
}

TEST(VolumeLoop, the_seed_decides_every_byte) {
  VolumeLoopConfig config = small_loop("cap");
  config.volumes = 1;
  const auto first = complete_loop(config);
  const auto again = complete_loop(config);
  config.seed = 2;
  const auto other = complete_loop(config);
  EXPECT_TRUE(std::ranges::equal(first->frame(0, 3), again->frame(0, 3)));
  EXPECT_FALSE(std::ranges::equal(first->frame(0, 3), other->frame(0, 3)));
}

TEST(VolumeLoop, tissue_keeps_its_speckle_and_blood_does_not) {
  VolumeLoopConfig config = *suggested_loop("nail_fold");
  config.plan.samples = 512;
  config.plan.depth_spacing_um = 7;
  config.plan.a_scans = 60;
  config.plan.a_spacing_um = 50;
  config.plan.b_scans = 6;
  config.plan.b_spacing_um = 230;
  config.plan.fly_back_lines = 2;
  config.volumes = 2;
  const auto loop = complete_loop(config);
  Correlation tissue;
  Correlation blood;
  Column column;
  for (int b = 0; b < 3; ++b) { // the skin's side
    for (int a = 0; a < config.plan.a_scans; ++a) {
      loop->phantom().fill(column, 0, static_cast<float>((a - 29.5) * 0.05),
                           static_cast<float>((b - 2.5) * 0.23));
      const auto first = a_scan(*loop, 0, b, a);
      const auto second = a_scan(*loop, 1, b, a);
      const bool vessel =
          std::ranges::any_of(column.layers(), [](const Layer& layer) { return layer.flowing; });
      const float top = column.layers().front().top_mm;
      for (std::size_t d = 8; d < 130; ++d) {
        const float z = static_cast<float>(d) * 0.007F;
        if (!vessel && z > top + 0.05F && z < top + 0.4F)
          tissue.add(first[d], second[d]);
        // Only deep inside a lumen: at its rim the tissue's light leaks in.
        const bool lumen = std::ranges::any_of(column.layers(), [&](const Layer& layer) {
          return layer.flowing && z > layer.top_mm + 0.021F && z < layer.bottom_mm - 0.021F;
        });
        if (lumen)
          blood.add(first[d], second[d]);
      }
    }
  }
  EXPECT_GT(tissue.count(), 2000);
  EXPECT_GT(blood.count(), 60);
  EXPECT_GT(tissue.value(), 0.95);
  EXPECT_LT(blood.value(), 0.3);
  RecordProperty("tissue_correlation", std::to_string(tissue.value()));
  RecordProperty("blood_correlation", std::to_string(blood.value()));
}

TEST(VolumeLoop, surfaces_lie_at_their_depth_in_millimetres) {
  VolumeLoopConfig config = small_loop("anterior_eye");
  config.volumes = 1;
  config.plan.samples = 512;
  config.plan.depth_spacing_um = 18;
  const auto loop = complete_loop(config);
  int tried = 0;
  for (int b = 2; b < 5; ++b) {
    for (int a = 5; a < 14; ++a) {
      const double x = (a - 12) * config.plan.a_spacing_um * 1e-3;
      const double y = (b - 3) * config.plan.b_spacing_um * 1e-3;
      const auto r =
          static_cast<float>(std::hypot(x - static_cast<double>(AnteriorEye::axis_x_mm), y));
      if (r > 1)
        continue; // where the cornea faces the beam
      const auto scan = a_scan(*loop, 0, b, a);
      const auto brightest =
          std::max_element(scan.begin() + 10, scan.begin() + 60, [](const auto& p, const auto& q) {
            return std::norm(p) < std::norm(q);
          });
      EXPECT_NEAR(static_cast<double>(brightest - scan.begin()) * 0.018,
                  static_cast<double>(AnteriorEye::cornea_front_mm(r)), 0.018 * 0.75);
      ++tried;
    }
  }
  EXPECT_GE(tried, 3);
}

TEST(VolumeLoop, the_beam_flies_back_over_the_same_b_scan) {
  VolumeLoopConfig config = small_loop("nail_fold");
  config.volumes = 1;
  const auto loop = complete_loop(config);
  // The one fly-back line is half-way: over the middle of 25 A-scans.
  const auto flying = a_scan(*loop, 0, 2, 25);
  const auto middle = a_scan(*loop, 0, 2, 12);
  const auto aside = a_scan(*loop, 0, 2, 3);
  Correlation same;
  Correlation other;
  for (std::size_t d = 8; d < 80; ++d) {
    same.add(flying[d], middle[d]);
    other.add(flying[d], aside[d]);
  }
  EXPECT_GT(same.value(), 0.9);
  EXPECT_LT(other.value(), 0.5);
}

TEST(VolumeLoop, lines_stay_within_the_cameras_range) {
  const auto loop = complete_loop(small_loop("anterior_eye"));
  int low = 4095;
  int high = 0;
  for (int b = 0; b < 7; ++b) {
    for (int line = 0; line < 26; ++line) {
      const auto [least, most] = std::ranges::minmax(line_of(*loop, 0, b, line));
      low = std::min<int>(low, least);
      high = std::max<int>(high, most);
    }
  }
  EXPECT_GT(low, 0);
  EXPECT_LT(high, 4095) << "saturated";
  EXPECT_GT(high, 1500) << "badly lit";
}

TEST(VolumeLoop, a_volume_stays_whole_while_the_ring_grows) {
  VolumeLoopConfig config = small_loop("cap");
  config.volumes = 40;
  const auto loop = VolumeLoop::make(config);
  ASSERT_TRUE(loop);
  std::uint64_t volume = 0;
  while ((*loop)->ready_volumes() < config.volumes) {
    const std::byte* start = (*loop)->frame(volume, 0).data();
    for (int b = 1; b < 7; ++b) {
      const auto frame = (*loop)->frame(volume, b);
      ASSERT_EQ(frame.data(), start + static_cast<std::size_t>(b) * frame.size());
    }
    ++volume;
    std::this_thread::sleep_for(std::chrono::microseconds{200});
  }
  EXPECT_GT(volume, 1U);
  EXPECT_TRUE(std::ranges::equal((*loop)->frame(40'000, 0), (*loop)->frame(40'040, 0)));
}

TEST(VolumeLoop, its_end_does_not_wait_for_the_ring) {
  VolumeLoopConfig config = small_loop("nail_fold");
  config.plan.a_scans = 300;
  config.plan.samples = 1024;
  config.volumes = 255;
  auto loop = VolumeLoop::make(config);
  ASSERT_TRUE(loop);
  ASSERT_LT((*loop)->ready_volumes(), 255);
  const auto start = std::chrono::steady_clock::now();
  loop->reset();
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds{2});
}

TEST(VolumeLoop, impossible_loops_are_refused) {
  VolumeLoopConfig none = small_loop("cap");
  none.volumes = 0;
  EXPECT_EQ(VolumeLoop::make(none).error().code, hal::ErrorCode::invalid_argument);
  VolumeLoopConfig unknown = small_loop("cap");
  unknown.phantom = "teapot";
  EXPECT_FALSE(VolumeLoop::make(unknown));
  EXPECT_FALSE(suggested_loop("teapot"));
  VolumeLoopConfig empty = small_loop("cap");
  empty.plan.b_scans = 0;
  EXPECT_FALSE(VolumeLoop::make(empty));
}

} // namespace
} // namespace octascope::sim
