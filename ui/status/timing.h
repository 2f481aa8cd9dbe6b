// Where the time of the last volumes went, thread by thread, for the timing diagram. Plain data,
// filled in by the host.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "hal/clock.h"

namespace octascope::ui {

// What works or waits, from above.
enum class TimingRow : std::uint8_t {
  exposure,   // the camera's sensor
  camera,     // the camera thread
  workers,    // all of them
  fixed_rate, // the fixed-rate thread
  buffer,     // the triple buffer between it and the render thread
  render,     // the render thread
  glass,      // the display
};
inline constexpr std::size_t timing_row_count = 7;

struct TimingBar {
  hal::TimePoint begin{}, end{};
  TimingRow row = TimingRow::exposure;
  bool waits = false;       // the volume waits; else it is worked on
  std::uint32_t worker = 0; // in the workers' row, from 0
};

// One volume's way to the glass.
struct TimedVolume {
  std::uint64_t index = 0; // 0: none yet
  hal::TimePoint last_line{}, flipped{};
  std::vector<TimingBar> bars; // in no order; keeps its capacity
};

struct Timing {
  std::array<TimedVolume, 3> volumes; // the last that were shown, in no order
  std::uint64_t newest = 0;           // index of the newest; 0: none
  std::uint32_t workers = 1;          // that were seen

  const TimedVolume& newest_volume() const {
    return *std::ranges::max_element(volumes, {}, &TimedVolume::index);
  }
};

} // namespace octascope::ui
