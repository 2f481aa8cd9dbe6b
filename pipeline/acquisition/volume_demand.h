// Whether a volume that is about to be scanned would be seen.
//
// Where a picture takes longer than the scan of a volume, some volumes are replaced by their
// successors before the renderer comes to them. To reconstruct those would only take the cores from
// the picture that somebody waits for. Where B-scans are shown as they come, that holds for those of
// a volume that is whole before its first one is seen.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <optional>

#include "hal/clock.h"
#include "pipeline/acquisition/volume_feed.h"

namespace octascope::pipeline {

// Wait-free. One thread asks, the renderer's thread tells.
class VolumeDemand {
public:
  // Renderer.
  void expect(Showing how) { expected_.store(how, std::memory_order_relaxed); }
  Showing expected() const { return expected_.load(std::memory_order_relaxed); }

  // Renderer. It took a volume that was published at that time; it began a frame with other news; it has
  // drawn what it took and began.
  void taken(hal::TimePoint published);
  void begun(hal::TimePoint now);
  void drawn(hal::TimePoint now);

  // A volume whose scan begins at `pulsed` and lasts for `period`. `waits_since`: when one before it was
  // published, if the renderer has not taken one since; `another_is_built`: which is going to be published,
  // too. Whole volumes: whether the renderer is likely to be free by the middle of the successor's scan.
  // Rolling: by the end of the volume's own scan.
  bool would_be_seen(hal::TimePoint pulsed, hal::Duration period,
                     std::optional<hal::TimePoint> waits_since, bool another_is_built) const;

private:
  static constexpr hal::TimePoint idle = hal::TimePoint::min();

  hal::TimePoint likely_free(hal::TimePoint now, std::optional<hal::TimePoint> waits_since) const;

  std::atomic<Showing> expected_{Showing::nothing};
  std::atomic<hal::TimePoint> busy_since_{idle};
  std::atomic<hal::Duration> drawing_{hal::Duration{}}; // so long or less, two times of three
  std::atomic<hal::TimePoint> last_drawn_{idle};
  // The renderer's.
  std::array<hal::Duration, 16> lately_{}; // in any order
  std::size_t oldest_ = 0;
};

} // namespace octascope::pipeline
