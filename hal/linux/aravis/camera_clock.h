// From a camera's own time stamps to the host's clock. Pure: times in, times out.
//
// A frame's stamp is exact, but of a clock that began at another time and runs at another rate; its
// arrival is on the host's clock, but late by what transport and scheduling took. The clocks' distance,
// drawn over the camera's time, is therefore a line below all points (stamp, arrival less stamp), as high
// as it can be: it lies on the lower hull of the points of the last half minute, along the hull's longest
// edge, which tells the rate best (Moon, Skelly and Towsley, INFOCOM 1999; Zhang, Liu and Xia, INFOCOM
// 2002). A late frame lies above the hull and changes nothing.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "hal/clock.h"

namespace octascope::hal::linux_backend {

class CameraClock {
public:
  // How much faster or slower than the host's a camera's clock may be: beyond any crystal's, and wide
  // enough for one that does not quite know its own frequency.
  static constexpr double most_drift = 0.01;

  // The time at which the frame stamped `stamp_ns` was complete, never later than `arrival`. In the
  // first second the rate is not known: the time may be late then, too, by most_drift of what passed
  // since the promptest frame. Where the stamp is of no use it is `arrival`: one of 0, one that does
  // not advance, one that is 10 ms before its time or all of which are that much behind for 3 s (the
  // camera's clock was set), and those of a clock of another rate. What follows is compared anew.
  TimePoint end_of_frame(std::uint64_t stamp_ns, TimePoint arrival);

  // False once stamps were of no use for five seconds of frames more than they were of use, until
  // they made up for that; all frames have their arrivals meanwhile.
  bool fits() const { return fits_; }

private:
  // More than the promptest frames of any second differ in what their transport took.
  static constexpr double most_difference_ns = 10e6;
  static constexpr double memory_ns = 30e9;
  static constexpr double learning_ns = 1e9;

  struct Point { // since the hull's first
    double stamp_ns = 0;
    double distance_ns = 0; // host less camera
  };

  void note_use(bool of_use, TimePoint arrival);
  std::optional<TimePoint> from_stamp(std::uint64_t stamp_ns, TimePoint arrival);
  bool has_leapt(const Point& point, TimePoint arrival);
  void add(const Point& point);
  void forget_old();
  std::optional<double> rate() const;
  double distance_at(double stamp_ns, double rate) const;
  Point& last() { return hull_[vertices_ - 1]; }
  double span_ns() const { return hull_[vertices_ - 1].stamp_ns - hull_[0].stamp_ns; }

  std::array<Point, 64> hull_{}; // the lower one, by stamp
  std::size_t vertices_ = 0;
  std::uint64_t first_stamp_ns_ = 0;
  Duration first_distance_{};
  std::uint64_t last_stamp_ns_ = 0;
  std::optional<TimePoint> behind_since_;
  std::optional<TimePoint> last_arrival_;
  Duration unfit_{};
  bool fits_ = true;
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

  // Whether a frame surely has this number: it is soon after the last one. None is before the first,
  // as a buffer may hold that of a frame of long ago.
  bool follows(std::uint64_t id) const { return begun_ && step_to(id) - 1 < most_doubtful; }

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
