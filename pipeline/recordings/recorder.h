// Records the volumes of a run in the background.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "hal/clock.h"
#include "pipeline/faults/fault_log.h"
#include "pipeline/recordings/recording_writer.h"
#include "pipeline/threads/index_ring.h"
#include "pipeline/threads/role_thread.h"
#include "pipeline/threads/wakeup.h"

namespace octascope::pipeline {

struct RecorderStatus {
  bool on = false;                   // volumes are being taken
  hal::TimePoint since;              // valid while `on`
  std::uint64_t kept = 0;            // volumes of this recording, or of the last
  std::uint64_t not_kept = 0;        // no place was free: the disk was too slow
  std::optional<std::uint64_t> room; // volumes that the disk still takes; empty: not known yet
};

// The fixed-rate thread offers each volume and never waits: the volume is copied to a free place,
// or counted as not kept. A writing thread empties the places. A recording ends before the disk is
// full, when writing fails, or when its file is removed, moved or replaced; each is a fault of the
// device "recording". The volumes written by then stay in the file.
class Recorder {
public:
  // `places`: how many volumes may wait for the disk. The thread allocates all of them when it
  // starts, so that no picture waits for it.
  Recorder(const VolumeGeometry& geometry, std::size_t places, hal::Clock& clock, FaultLog& faults,
           Wakeup& news);

  void start(const ThreadSetup& setup);
  // Finishes the recording, if there is one, and ends the thread.
  void stop() { thread_.stop(); }

  // Render thread only. Returns at once; failures become faults. False: the last recording is still
  // being finished.
  bool begin(std::filesystem::path file, RecordingFacts facts);
  void end();

  // Fixed-rate thread: copies the volume if a recording is on.
  void offer(const Volume& volume);

  // Any thread. Whether volumes are being taken, or will be as soon as the file is made.
  bool is_on() const {
    const State state = state_.load(std::memory_order_relaxed);
    return state == State::beginning || state == State::on;
  }
  // Any thread.
  RecorderStatus status() const;
  // Of this recording, or of the last: why it did not begin, ended by itself, or is no longer there
  // (ErrorCode::absent). Empty: nothing of that.
  std::optional<hal::Error> failure() const;

private:
  enum class State : std::uint8_t {
    idle,
    beginning, // the file is being made
    on,
    ending, // what waits is being written
  };
  struct Place {
    Volume volume;
    RecordedVolume entry;
    std::uint64_t recording = 0; // for which one it was taken
  };

  void run();
  void make_places();
  void serve();
  void come_on();
  bool open();
  void write_waiting();
  void write(const Place& place);
  void finish();
  void give_up(Fault fault, const hal::Error& error);
  void fail(Fault fault, const hal::Error& error);

  const VolumeGeometry geometry_;
  hal::Clock& clock_;
  FaultLog& faults_;
  Wakeup& news_;
  std::vector<Place> places_; // each has its volume before it is free for the first time
  IndexRing free_;            // the thread's → the fixed-rate thread's
  IndexRing waiting_;         // and back
  std::atomic<State> state_{State::idle};
  std::atomic<std::uint64_t> taking_{0}; // the number of the recording that volumes are taken for
  std::atomic<std::int64_t> since_ns_{0};
  std::atomic<std::uint64_t> kept_{0};
  std::atomic<std::uint64_t> not_kept_{0};
  std::atomic<std::uint64_t> room_{0}; // volumes; 0: not known
  Wakeup wakeup_;

  mutable std::mutex mutex_; // of what is to begin, and of how it went
  std::filesystem::path file_;
  RecordingFacts facts_;
  std::optional<hal::Error> failure_;

  // The thread's.
  std::optional<RecordingWriter> writer_;
  std::filesystem::path open_file_;
  std::uint64_t recordings_ = 0; // begun so far
  hal::TimePoint synced_;
  RoleThread thread_{&wakeup_};
};

} // namespace octascope::pipeline
