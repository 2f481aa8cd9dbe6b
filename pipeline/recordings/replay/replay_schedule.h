// When each volume of a recording is shown. Pure.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "hal/clock.h"
#include "pipeline/recordings/recording.h"

namespace octascope::pipeline {

inline constexpr double slowest_replay = 0.1;
inline constexpr double fastest_replay = 100;

// Volumes follow each other as they were published, so that the time of one that was lost passes,
// too. Nobody waits through a pause, of a recording that was held up or of a machine that slept:
// one of more than longest_pause is shortened to shortened_pause. A volume that by its times is no
// later than the one before, as in damaged metadata, comes a planned period after it.
class ReplaySchedule {
public:
  static constexpr hal::Duration longest_pause = std::chrono::seconds{5};
  static constexpr hal::Duration shortened_pause = std::chrono::seconds{2};

  // `period` is the planned one, with which the last volume is shown, too. At a `rate` of 2 all
  // comes twice as fast; it is brought between slowest_replay and fastest_replay.
  ReplaySchedule(std::span<const RecordedVolume> volumes, hal::Duration period, double rate);

  std::size_t size() const { return offsets_.size(); }

  // After the first one.
  hal::Duration offset(std::size_t n) const { return offsets_[n]; }

  // All of it, until the first one comes again.
  hal::Duration length() const { return length_; }

  // How much of the pause before the `n`th was left out, as it was recorded; 0: nothing.
  hal::Duration left_out_before(std::size_t n) const;

private:
  struct Pause {
    std::size_t before;
    hal::Duration left_out;
  };

  std::vector<hal::Duration> offsets_;
  hal::Duration length_{};
  std::vector<Pause> pauses_; // in order
};

// From one recorded time to a later one; 0 where it is not later. However wrong a damaged file has
// them, it overflows nothing: it is never more than a day.
hal::Duration recorded_step(std::int64_t from_ns, std::int64_t to_ns);

} // namespace octascope::pipeline
