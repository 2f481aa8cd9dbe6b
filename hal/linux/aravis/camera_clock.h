// From a camera's own time stamps to the host's clock. Pure: times in, times out.
//
// A frame's stamp is exact, but of a clock that began at another time and runs at another rate; its
// arrival is on the host's clock, but late by what transport and scheduling took. The least delay
// seen is taken as the clocks' distance (a minimum filter, as in NTP's clock filter, RFC 5905
// section 10), and is let grow slowly, so that a camera's clock that runs slower is followed.
#pragma once

#include <cstdint>
#include <optional>

#include "hal/clock.h"

namespace octascope::hal::linux_backend {

class CameraClock {
public:
  // How much faster or slower than the host's a camera's clock may be: beyond any crystal's.
  static constexpr double most_drift = 200e-6;

  // The time at which the frame stamped `stamp_ns` was complete, never later than `arrival`. A
  // stamp of 0, one that does not advance, and one that is a second off (the camera's clock was
  // reset) give `arrival`, and the next stamps are compared with that anew.
  TimePoint end_of_frame(std::uint64_t stamp_ns, TimePoint arrival);

private:
  std::optional<Duration> distance_; // host less camera
  std::uint64_t last_stamp_ns_ = 0;
};

// Extends the frame number that a camera sends to one that counts from 0 at the first frame.
// GigE Vision's block numbers have 16 bits, leave out 0 and begin again at 1 (GigE Vision 1.x), or
// have 64 bits (2.x), as USB3 Vision's have.
class FrameCounter {
public:
  std::uint64_t extend(std::uint64_t id) {
    total_ = begun_ ? total_ + step_to(id) : guesses_;
    begun_ = true;
    guesses_ = 0;
    last_ = id;
    return total_;
  }

  // Whether a frame may have this number: it is soon after the last one.
  bool follows(std::uint64_t id) const {
    return begun_ ? step_to(id) - 1 < most_doubtful : id != 0;
  }

  // The number of a frame whose own was lost: the next.
  std::uint64_t guess() {
    ++guesses_;
    return begun_ ? total_ + guesses_ : guesses_ - 1;
  }

private:
  static constexpr std::uint64_t most_short = 0xFFFF;
  static constexpr std::uint64_t most_doubtful = 1024;

  // 0 for a number that does not advance.
  std::uint64_t step_to(std::uint64_t id) const {
    if (id > last_)
      return id - last_;
    const bool wraps = last_ <= most_short && last_ - id > most_short / 2;
    return wraps ? id + most_short - last_ : 0;
  }

  bool begun_ = false;
  std::uint64_t last_ = 0;
  std::uint64_t total_ = 0;
  std::uint64_t guesses_ = 0; // since the last known number
};

} // namespace octascope::hal::linux_backend
