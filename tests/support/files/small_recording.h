// A small recording, and volumes that differ from each other in every voxel.
#pragma once

#include <cstdint>
#include <filesystem>

#include <gtest/gtest.h>

#include "pipeline/recordings/recording_writer.h"

namespace octascope::tests {

inline pipeline::RecordingFacts small_recording_facts() {
  return {.geometry = {12, 7, 5, 3.5, 10, 37.5, 1.38},
          .volume_period_s = 0.141,
          .recorded_by = "octascope, in a test",
          .begun = "2026-11-22T12:10:03+01:00",
          .source = "phantom eye",
          .simulated = true,
          .subject = "Müller, 17",
          .eye = pipeline::Eye::left,
          .configuration = "# none\n"};
}

// The `n`th from 0: its second B-scan is missing and its last saturated, and its index skips
// one after the second volume.
inline pipeline::Volume small_recording_volume(std::uint64_t n) {
  pipeline::Volume volume{small_recording_facts().geometry};
  for (std::size_t i = 0; i < volume.levels.size(); ++i)
    volume.levels[i] = static_cast<std::uint8_t>(i * 7 + n * 31);
  volume.b_scan_states.assign(volume.b_scan_states.size(), pipeline::BScanState::good);
  volume.b_scan_states[1] = pipeline::BScanState::missing;
  std::ranges::fill(volume.b_scan(1), std::uint8_t{0});
  volume.b_scan_states.back() = pipeline::BScanState::saturated;
  const auto at = [&](std::int64_t ms) {
    return hal::TimePoint{std::chrono::milliseconds{100'000 + 141 * static_cast<int>(n) + ms}};
  };
  volume.metadata = {.index = n + (n > 1 ? 2 : 1),
                     .pulsed = at(0),
                     .first_line = at(1),
                     .last_line = at(135),
                     .published = at(138),
                     .lost_b_scans = 1,
                     .lost_lines = 7,
                     .saturated_lines = 3,
                     .scan_lag_a_scans = 0.25};
  return volume;
}

inline constexpr std::int64_t small_recording_begun_ns = 1'795'345'803'000'000'000;

inline pipeline::RecordedVolume small_recording_entry(std::uint64_t n) {
  return entry_of(small_recording_volume(n).metadata,
                  small_recording_begun_ns + static_cast<std::int64_t>(n) * 141'000'000);
}

inline void append_small_volumes(pipeline::RecordingWriter& writer, std::uint64_t from,
                                 std::uint64_t until) {
  for (std::uint64_t n = from; n < until; ++n) {
    const auto appended = writer.append(small_recording_volume(n), small_recording_entry(n));
    ASSERT_TRUE(appended) << appended.error().message;
  }
}

inline void write_small_recording(const std::filesystem::path& file, std::uint64_t volumes) {
  auto writer = pipeline::RecordingWriter::create(file, small_recording_facts());
  ASSERT_TRUE(writer) << writer.error().message;
  append_small_volumes(*writer, 0, volumes);
  const auto finished = writer->finish({.not_kept = 2});
  ASSERT_TRUE(finished) << finished.error().message;
}

} // namespace octascope::tests
