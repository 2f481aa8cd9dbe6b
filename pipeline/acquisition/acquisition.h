// The camera thread: fetches B-scans from the line camera and queues them for the pipeline.
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <thread>
#include <vector>

#include "hal/clock.h"
#include "hal/line_camera.h"
#include "pipeline/faults/fault_log.h"
#include "pipeline/threads/index_ring.h"
#include "pipeline/threads/retry_delay.h"
#include "pipeline/threads/wakeup.h"
#include "pipeline/threads/worker_pool.h"

namespace octascope::pipeline {

struct AcquisitionCounters {
  std::uint64_t frames = 0;     // good ones, queued
  std::uint64_t unusable = 0;   // flagged as corrupted, or of the wrong size
  std::uint64_t gaps = 0;       // missing sequence numbers
  std::uint64_t overflowed = 0; // pushed out of the full queue by newer ones
};

// Frames are borrowed from the camera and travel by number, without a copy. The queue is bounded
// by the camera's buffers and drops the oldest, counted. The camera may vanish and come back at
// any time: it is reopened with a back-off of 0.1 s to 2 s. One that streams and falls silent
// without an error, although the scanner is pulsed, is opened anew after 3 s, then 6, 12 and 24: it
// may as well be the scanner that is off.
class Acquisition {
public:
  // `camera`, `clock` and `faults` outlive this. `arrived` is posted after each queued frame, and
  // after the look that somebody asked for.
  Acquisition(hal::LineCamera& camera, const hal::LineCameraConfig& config, hal::Clock& clock,
              FaultLog& faults, Wakeup& arrived);
  ~Acquisition();

  // Opens the camera (an Error if that fails for a reason that waiting cannot fix: a wrong
  // configuration) and starts the thread.
  hal::Result<> start(const ThreadSetup& setup);

  // Ends the thread, waits for loans, closes the camera. No frame is handed out afterwards.
  void stop();

  // One consumer thread. The frame is on loan until release(frame.buffer).
  std::optional<hal::LineFrame> take();

  // Any thread.
  void release(int buffer);

  // Any thread, wait-free: what the camera had to give until then, by when it was exposed, is in
  // the queue or was dropped. To know that nothing earlier will come, ask before taking what is
  // queued.
  hal::TimePoint looked_until() const { return looked_until_.load(std::memory_order_acquire); }

  // Any thread, wait-free: `arrived` is posted after the first look that reaches `until`, be it
  // with a frame or without. The last who asks is served.
  void ask_for_look(hal::TimePoint until) { awaited_look_.store(until, std::memory_order_relaxed); }

  // Any thread, wait-free: a pulse should have brought frames, and brought none.
  void note_unanswered_pulse() { unanswered_.store(true, std::memory_order_relaxed); }

  // Any thread.
  AcquisitionCounters counters() const;

private:
  void run();
  bool open_and_start();
  void close_when_returned();
  void receive(const hal::LineFrame& frame);
  void mend_silence();
  void check_sequence(std::uint64_t sequence);
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
  std::atomic<int> on_loan_{0};                // queued or with the pipeline
  std::optional<std::uint64_t> last_sequence_; // of this stream
  std::uint64_t repeated_ = 0;                 // frames since then with the same number
  RetryDelay retry_;
  std::optional<hal::TimePoint> silent_since_; // pulses go out, and no frame comes
  hal::Duration patience_;                     // with that

  std::atomic<std::uint64_t> good_{0}, unusable_{0}, gaps_{0}, overflowed_{0};
  std::atomic<hal::TimePoint> looked_until_{hal::TimePoint{}};
  std::atomic<hal::TimePoint> awaited_look_{hal::TimePoint::max()};
  std::atomic<bool> unanswered_{false};
  std::atomic<bool> stopping_{false};
  std::thread thread_;
};

} // namespace octascope::pipeline
