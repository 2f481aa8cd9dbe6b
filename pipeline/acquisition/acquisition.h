// The camera thread: fetches B-scans from the line camera and queues them for the pipeline.
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <vector>

#include "hal/clock.h"
#include "hal/line_camera.h"
#include "pipeline/faults/fault_log.h"
#include "pipeline/threads/index_ring.h"
#include "pipeline/threads/retry_delay.h"
#include "pipeline/threads/role_thread.h"
#include "pipeline/threads/wakeup.h"

namespace octascope::pipeline {

struct AcquisitionCounters {
  std::uint64_t frames = 0;     // good frames, queued
  std::uint64_t unusable = 0;   // flagged as corrupted, or of the wrong size
  std::uint64_t gaps = 0;       // missing sequence numbers
  std::uint64_t overflowed = 0; // dropped from the full queue to make room for newer frames
};

// Frames are borrowed from the camera and passed on by buffer number, without copying. The queue
// holds as many frames as the camera has buffers; when full it drops and counts the oldest. The
// camera may disconnect and return at any time: it is reopened with a back-off of 0.1 s to 2 s. A
// camera that reports no error but sends no frames although the scanner is pulsed is reopened after
// 3 s, then 6 s, 12 s and every 24 s: the cause may equally be a scanner that is off.
class Acquisition {
public:
  // `camera`, `clock` and `faults` outlive this. `arrived` is posted after each queued frame,
  // or at most every millisecond where frames come more often, and after a poll requested by
  // ask_for_look().
  Acquisition(hal::LineCamera& camera, const hal::LineCameraConfig& config, hal::Clock& clock,
              FaultLog& faults, Wakeup& arrived);

  // Opens the camera and starts the thread. Returns an Error only for a wrong configuration
  // (ErrorCode::invalid_argument); after any other failure the thread keeps trying.
  hal::Result<> start(const ThreadSetup& setup);

  // Ends the thread, waits for frames on loan, closes the camera. No frame is handed out after it.
  void stop() { thread_.stop(); }

  // One consumer thread. The frame is on loan until release(frame.buffer).
  std::optional<hal::LineFrame> take();

  // Any thread.
  void release(int buffer);

  // Any thread, wait-free: every frame exposed up to this time has been queued or dropped. To be
  // sure that no earlier frame will follow, read this before draining the queue.
  hal::TimePoint looked_until() const { return looked_until_.load(std::memory_order_acquire); }

  // Any thread, wait-free: posts `arrived` once looked_until() reaches `until`, whether or not a
  // frame came. A new request replaces the previous one.
  void ask_for_look(hal::TimePoint until) { awaited_look_.store(until, std::memory_order_relaxed); }

  // Any thread, wait-free: a pulse that should have produced frames produced none.
  void note_unanswered_pulse() { unanswered_.store(true, std::memory_order_relaxed); }

  // Any thread. How many of the camera's buffers are queued or with the pipeline.
  int on_loan() const { return on_loan_.load(std::memory_order_relaxed); }
  // Of how many: drivers give fewer than they are asked for.
  int buffers() const { return buffers_.load(std::memory_order_relaxed); }

  // Any thread.
  AcquisitionCounters counters() const;

private:
  void run();
  bool look(hal::Duration timeout);
  void gather();
  bool open_and_start();
  void close_when_returned();
  void receive(const hal::LineFrame& frame);
  void mend_silence();
  void check_sequence(std::uint64_t sequence);
  void check_times(const hal::LineFrame& frame);
  void give_back(int buffer);
  void wait_before_retry();
  void note_look(hal::TimePoint until);

  hal::LineCamera& camera_;
  hal::LineCameraConfig config_;
  hal::Clock& clock_;
  FaultLog& faults_;
  Wakeup& arrived_;

  std::vector<hal::LineFrame> frames_; // by buffer number; written before the number is queued
  IndexRing queue_;
  bool gathers_ = false; // frames come too often to be told of one by one
  std::atomic<int> buffers_;
  std::atomic<int> on_loan_{0};                // queued or with the pipeline
  std::optional<std::uint64_t> last_sequence_; // of this stream
  std::uint64_t repeated_ = 0;                 // later frames with the same number
  std::optional<hal::TimePoint> stamps_told_;  // while frames are timed by the host
  RetryDelay retry_;
  std::optional<hal::TimePoint> silent_since_; // no frames since then, despite pulses
  hal::Duration patience_;                     // how long that is tolerated before reopening

  std::atomic<std::uint64_t> good_{0}, unusable_{0}, gaps_{0}, overflowed_{0};
  std::atomic<hal::TimePoint> looked_until_{hal::TimePoint{}};
  std::atomic<hal::TimePoint> awaited_look_{hal::TimePoint::max()};
  std::atomic<bool> unanswered_{false};
  RoleThread thread_;
};

} // namespace octascope::pipeline
