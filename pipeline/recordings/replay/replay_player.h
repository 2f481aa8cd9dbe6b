// Reads the volumes of a recording, one ahead, and publishes each when it is due.
//
// The steps of ReplayThread, without the thread, so that a test can own the time.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "hal/clock.h"
#include "hal/result.h"
#include "pipeline/acquisition/volume_feed.h"
#include "pipeline/faults/fault_log.h"
#include "pipeline/recordings/recording.h"
#include "pipeline/recordings/recording_reader.h"
#include "pipeline/recordings/replay/replay_schedule.h"
#include "pipeline/threads/triple_buffer.h"
#include "pipeline/threads/wakeup.h"

namespace octascope::pipeline {

// What is replayed.
struct ReplaySource {
  RecordingFacts facts;
  std::vector<RecordedVolume> volumes; // not empty
  // As RecordingReader::read(); called on one thread only.
  std::function<hal::Result<>(std::size_t n, Volume& volume)> read;
};

// ErrorCode::bad_data: it holds no volumes; the message does not name the file.
hal::Result<ReplaySource> replay_source(RecordingReader reader);

struct ReplaySetup {
  double rate = 1;                             // as ReplaySchedule takes it
  bool once = false;                           // ends after the last volume; otherwise it repeats
  std::optional<std::uint64_t> most_volumes{}; // ends after so many
};

enum class ReplayEnd : std::uint8_t {
  none,       // it goes on
  done,       // everything that was asked for has been published
  unreadable, // no volume could be read any more: the fault log says why
};

// A published volume has the recorded times, all shifted so that it was ready when it is published
// here; its index stays, and `recorded_ns` marks it as recorded. Missing B-scans stay missing and
// blank. Volumes lost in the recording count as lost at their place. A volume that cannot be read
// counts as lost, too, and is a fault ("recording", "unreadable_volume"); the replay continues with
// the next one, and ends if no volume of a whole pass can be read.
//
// Holds three volumes, however long the recording is; allocates nothing once made, except for
// faults.
class ReplayPlayer final : public VolumeFeed {
public:
  // `faults` and `news`, which is posted after each published volume, outlive it.
  ReplayPlayer(ReplaySource source, const ReplaySetup& setup, FaultLog& faults, Wakeup& news);

  // One thread: does what is due and returns when it must be called again at the latest.
  hal::TimePoint step(hal::TimePoint now);

  // Any thread; all take effect at the next step.
  void seek(std::size_t n); // continues from volume n, counted from 0
  void hold(bool held);     // while held, nothing is published and the replay's time stops

  // Any thread.
  ReplayEnd end() const { return end_.load(std::memory_order_acquire); }
  std::size_t position() const { return position_.load(std::memory_order_relaxed); } // published
  const ReplaySchedule& schedule() const { return schedule_; }
  const RecordingFacts& facts() const { return source_.facts; }

private:
  struct Counts {
    std::atomic<std::uint64_t> acquired{0}, skipped{0}, lost_lines{0}, lost_b_scans{0},
        lost_volumes{0}, saturated_lines{0};
  };

  // The renderer's side of the triple buffer.
  const Volume* do_take_newest() override;
  bool do_has_newer() const override { return buffer_.has_newer(); }
  VolumeCounters do_counters() const override;

  void follow_requests(hal::TimePoint now);
  void go_to(std::size_t n, hal::TimePoint now);
  hal::Result<> read_next();
  void prepare(hal::TimePoint now);
  void publish(hal::TimePoint now);
  void advance();
  void finish(ReplayEnd end) { end_.store(end, std::memory_order_release); }
  void count_lost(std::uint64_t volumes);
  void count_gap(std::uint64_t index);
  void count(const RecordedVolume& entry);

  ReplaySource source_;
  const ReplaySetup setup_;
  const ReplaySchedule schedule_;
  FaultLog& faults_;
  Wakeup& news_;

  std::vector<Volume> volumes_; // in the middle, the renderer's, and the one that is read
  TripleBuffer buffer_{1, 0};
  std::uint32_t reading_ = 2;

  std::size_t next_ = 0;
  bool prepared_ = false;               // volumes_[reading_] is the next one
  std::optional<hal::TimePoint> begun_; // when the recording's first volume was or would be due
  hal::TimePoint due_;                  // of the next one, once it is prepared
  std::optional<hal::TimePoint> held_since_;
  std::optional<std::uint64_t> last_index_; // of the volume before, to see what was lost between
  std::size_t unreadable_ = 0;              // so many in a row

  static constexpr std::size_t nowhere = ~std::size_t{0};
  std::atomic<std::size_t> wanted_{nowhere};
  std::atomic<bool> hold_{false};
  std::atomic<ReplayEnd> end_{ReplayEnd::none};
  std::atomic<std::size_t> position_{0};
  Counts counts_;
};

} // namespace octascope::pipeline
