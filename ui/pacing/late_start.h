// When a frame begins: as late as it can and still be shown at the next refresh. What is drawn right
// after a refresh is a whole period old when it is seen; what is begun late takes in what a hand did and
// what a camera saw meanwhile. Pure: times are arguments.
//
// What a frame takes is predicted as the longest of the last few; a margin comes on top of it, which
// grows when a refresh was missed and shrinks again while none is (as compositors for headsets do:
// Monado begins with a tenth of the period, stays below 30 %, and adds 4 % for a miss).
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "hal/clock.h"

namespace octascope::ui {

// Threads: one at a time. Allocates nothing.
class LateStart {
public:
  // The latest time, not before `now`, from which a frame is ready for the next refresh that it can
  // reach; half of the margin may be spent on having come too late. `refresh`: when one is or was
  // (others are whole periods from it); empty for an output that shows an image as soon as it is
  // there. `now` where there is nothing to gain: there, while nothing is known of what frames take, if
  // they take most of a period, and if the refresh is so long ago that the next ones cannot be told.
  hal::TimePoint begin(hal::TimePoint now, std::optional<hal::TimePoint> refresh,
                       hal::Duration period);

  // When the renderer looks again, at the latest, whether there is something to draw, having done so
  // at `began`: when the next frame begins, or else a period later.
  hal::TimePoint next_look(hal::TimePoint began, hal::TimePoint now,
                           std::optional<hal::TimePoint> refresh, hal::Duration period);

  // When a frame that is drawn at that time meets a refresh.
  static hal::TimePoint seen(hal::TimePoint drawn, std::optional<hal::TimePoint> refresh,
                             hal::Duration period);

  // Reports the frame that begin() was asked about, from its beginning until it was drawn, and when it
  // was seen.
  void note(hal::Duration cost, hal::TimePoint seen);

private:
  hal::Duration predicted() const;

  static constexpr std::size_t kept = 16;
  std::array<hal::Duration, kept> costs_{}; // of the last frames
  std::size_t frames_ = 0;
  double margin_ = 0.1; // of a period
  int met_ = 0;         // refreshes in a row
  hal::Duration period_{};
  std::optional<hal::TimePoint> planned_; // the refresh that begin() chose
};

} // namespace octascope::ui
