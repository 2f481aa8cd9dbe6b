#include <gtest/gtest.h>

#include "firmware-host/ledger/line_latency.h"

namespace octascope::firmware_host {
namespace {

using namespace std::chrono_literals;
using pipeline::BScanState;

constexpr hal::TimePoint start{1h};

// Of ten B-scans that take 10 ms each.
pipeline::Volume volume_from(hal::TimePoint first) {
  pipeline::Volume volume{pipeline::VolumeGeometry{4, 4, 10, 1, 1, 1}};
  for (std::size_t b = 0; b < 10; ++b) {
    volume.b_scan_states[b] = BScanState::good;
    auto& work = volume.work.emplace_back();
    work.first_line = first + b * 10ms;
    work.last_line = first + (b + 1) * 10ms;
  }
  return volume;
}

TEST(LineLatency, counts_every_line_from_its_exposure_to_the_flip) {
  LineLatency latency{10};
  latency.show(volume_from(start), {0, 10});
  EXPECT_EQ(latency.summary().count, 0U);
  latency.flipped(start + 120ms);
  const auto whole = latency.summary(); // 20 to 120 ms, evenly
  EXPECT_EQ(whole.count, 160U);
  EXPECT_NEAR(whole.p50_ms, 70, 1.5);
  EXPECT_NEAR(whole.p95_ms, 115, 2);
  EXPECT_NEAR(whole.max_ms, 120, 1);
}

TEST(LineLatency, is_short_where_b_scans_are_shown_as_they_come) {
  LineLatency latency{10};
  const pipeline::Volume volume = volume_from(start);
  for (int b = 0; b < 10; ++b) {
    latency.show(volume, {b, b + 1});
    latency.flipped(start + (b + 1) * 10ms + 5ms);
  }
  EXPECT_EQ(latency.summary().count, 160U);
  EXPECT_NEAR(latency.summary().p50_ms, 10, 1);
  EXPECT_LE(latency.summary().max_ms, 15);
}

TEST(LineLatency, counts_no_line_twice_nor_one_that_was_never_shown) {
  LineLatency latency{10};
  pipeline::Volume volume = volume_from(start);
  volume.b_scan_states[3] = BScanState::missing;
  volume.b_scan_states[4] = BScanState::seam;
  latency.show(volume, {0, 10});
  latency.flipped(start + 200ms);
  EXPECT_EQ(latency.summary().count, 128U);
  latency.show(volume, {0, 10}); // the whole volume, after its B-scans
  latency.flipped(start + 300ms);
  EXPECT_EQ(latency.summary().count, 128U);
  latency.show(volume_from(start + 1s), {0, 10});
  latency.forget(); // the display is gone
  latency.flipped(start + 3s);
  EXPECT_EQ(latency.summary().count, 128U);
}

} // namespace
} // namespace octascope::firmware_host
