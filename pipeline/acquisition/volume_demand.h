// Whether a volume that is about to be scanned would be seen.
//
// Where a picture takes longer than the scan of a volume, some volumes are replaced by their
// successors before the renderer comes to them. To reconstruct those would only take the cores from
// the picture that somebody waits for.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>

#include "hal/clock.h"

namespace octascope::pipeline {

// Wait-free. One thread asks, the renderer's thread tells.
class VolumeDemand {
public:
  // Renderer. It took a volume that was published at that time; it has drawn it.
  void taken(hal::TimePoint published);
  void drawn(hal::TimePoint now);

  // Whether the renderer is likely to be free by the middle of the successor's scan. The scan of the
  // volume begins at `pulsed` and lasts for `period`; `another_waits`: one before it that the renderer
  // has not taken yet.
  bool would_be_seen(hal::TimePoint pulsed, hal::Duration period, bool another_waits) const;

private:
  static constexpr hal::TimePoint idle = hal::TimePoint::min();

  std::atomic<hal::TimePoint> busy_since_{idle};
  std::atomic<hal::Duration> drawing_{hal::Duration{}}; // so long or less, two times of three
  // The renderer's.
  hal::TimePoint last_drawn_{};
  std::array<hal::Duration, 16> lately_{}; // in any order
  std::size_t oldest_ = 0;
};

} // namespace octascope::pipeline
