// Which tick gets a trigger pulse, where each frame goes, when a B-scan is made from what has come
// of it, and when a volume is published or lost: decided from times alone.
//
// B-scans are handed to the workers as they come, not at the end of the sweeps, so that almost
// nothing is left to do when the last one arrives. A volume is published when it is complete, or,
// with its missing B-scans marked, shortly after its sweeps should have ended, once the camera's
// thread has looked at the camera that long: a late camera never delays the tick, and a busy
// machine makes no frame late that the camera gave in time.
//
// With several sweeps of each B-scan, a B-scan is made when all of them have come; when one is
// missing, once the B-scan after the next has begun, or when the volume's time is over. A B-scan is
// missing when none of its sweeps came.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "hal/clock.h"
#include "pipeline/acquisition/volume_feed.h"
#include "pipeline/scan/scan_plan.h"
#include "pipeline/scan/sweep_tracker.h"

namespace octascope::pipeline {

struct BScanJob {
  std::uint32_t buffer = 0; // of the pool
  int b_scan = 0;

  bool operator==(const BScanJob&) const = default;
};

// What a tick wants.
struct TickDecision {
  std::uint64_t slept_through = 0; // ticks before this one that nobody asked about: lost volumes
  bool pulse = false;              // to be answered by pulsed(), pulse_failed() or not_ready()
};

enum class FrameVerdict : std::uint8_t {
  placed,
  outside, // exposed in no sweep of the last volumes
  doubled, // of a sweep that had come already
  late     // its B-scan was made, or its volume is over
};

// Where a frame goes, and what is to be handed to the workers once it is there, in this order. What
// is not `placed` is to be given back to the camera.
struct FrameDecision {
  FrameVerdict verdict = FrameVerdict::outside;
  std::uint32_t buffer = 0;
  int b_scan = 0;
  int repeat = 0;
  std::span<const BScanJob> submit{}; // valid until the next call
};

// What is known of a volume that is over.
struct FinishedVolume {
  std::uint64_t number = 0;                 // counts the pulses, from 1
  hal::TimePoint first_line{}, last_line{}; // of what came; the former of what came first
  std::int32_t lost_b_scans = 0, lost_lines = 0;
};

// What is to be done with the oldest volume under way.
struct VolumeDecision {
  enum class Action : std::uint8_t {
    wait,    // nothing until next_wake(), a frame, a finished B-scan, or the camera's thread's look
    look,    // ask the camera's thread to look until `look_until`
    submit,  // to the workers: the missing sweeps of these B-scans will not come
    publish, // `buffer` is as whole as it will be; published() tells what became of it
    lose     // nothing came; `buffer` is free again
  };
  Action action = Action::wait;
  std::uint32_t buffer = 0;
  hal::TimePoint look_until{};
  std::span<const BScanJob> submit{}; // valid until the next call
  FinishedVolume volume{};            // publish and lose
};

// Pure logic: no clock, no thread, no device. One thread, but for what says otherwise; allocates
// when it is made, never afterwards.
class VolumeScheduler {
public:
  static constexpr std::uint32_t pool_size = 5; // middle, renderer's, and three to build in
  // Of the pool, the buffers that are in the middle and with the renderer at first.
  static constexpr std::uint32_t first_middle = 0, first_front = 1;

  // With `most_volumes`, no more than so many are asked for.
  VolumeScheduler(const ScanPlan& plan, std::optional<std::uint64_t> most_volumes);

  // Ticks. The first is due at `first`.
  void begin(hal::TimePoint first) { next_tick_ = first; }
  bool tick_due(hal::TimePoint now) const { return now >= next_tick_; }
  TickDecision tick(hal::TimePoint now);

  // The pulse was made: the buffer to build its volume in, or none, and the volume is lost: the
  // workers are three volumes behind.
  std::optional<std::uint32_t> pulsed(hal::TimePoint when);
  // It was tried and failed.
  void pulse_failed();
  // There is no camera to pulse for, or no trigger. Before the first pulse nothing is lost by that.
  void not_ready();

  // A good frame, by the camera's times.
  FrameDecision place(hal::TimePoint first_line, hal::TimePoint last_line);

  // Any thread: a submitted B-scan of this buffer is made. What was written before is there when
  // the volume is published.
  void b_scan_made(std::uint32_t buffer) {
    pending_[buffer].made.fetch_add(1, std::memory_order_release);
  }

  // To be asked again until it says `wait`. `looked_until`: what the camera had given until then
  // was placed already; asked for before the frames were taken. `streaming`: the camera is.
  VolumeDecision next(hal::TimePoint now, hal::TimePoint looked_until, bool streaming);

  // What was to be published is: `recycled` came back for it, `skipped` if nobody had taken that.
  void published(std::uint32_t recycled, bool skipped);

  void count_saturated_lines(std::int32_t lines) { count(counts_.saturated_lines, lines); }

  // When the thread has something to do at the latest, however quiet it is. A time that is over when
  // it is asked for is told as it is: a tick that came due since tick_due() was asked waits no longer.
  hal::TimePoint next_wake(hal::TimePoint now) const;

  // What is under way will not be finished.
  void end() { counts_.unfinished.store(under_way(), std::memory_order_relaxed); }

  // Any thread.
  VolumeCounters counters() const;

private:
  struct BScanSlot {
    std::uint32_t came = 0; // one bit a repeat
    bool submitted = false; // from then on the frames are the worker's
  };
  // One for each buffer of the pool.
  struct PendingVolume {
    bool open = false;
    FinishedVolume facts; // so far
    hal::TimePoint accept_until;
    std::optional<hal::TimePoint> give_up_at; // set when that was over and the camera not looked at
    std::vector<BScanSlot> slots;             // by B-scan
    int sweeps_came = 0;
    int submitted = 0;
    int flushed = 0;          // B-scans before this one wait for no more sweeps
    std::atomic<int> made{0}; // B-scans that the workers are done with
  };
  struct Counts {
    std::atomic<std::uint64_t> planned{0}, triggered{0}, acquired{0}, published{0}, skipped{0},
        lost_lines{0}, lost_b_scans{0}, lost_volumes{0}, unfinished{0}, saturated_lines{0};
  };

  static void count(std::atomic<std::uint64_t>& counter, std::int64_t by = 1) {
    counter.fetch_add(static_cast<std::uint64_t>(by), std::memory_order_relaxed);
  }
  // Whether time decides about it; otherwise the workers do.
  bool awaits_sweeps(const PendingVolume& volume) const;
  void count_lost_volume();
  std::uint64_t under_way() const;
  std::optional<std::uint32_t> find(std::uint64_t number) const;
  std::optional<std::uint32_t> oldest() const;
  void submit(std::uint32_t buffer, int b_scan);
  void flush(std::uint32_t buffer, int end);
  VolumeDecision finish(std::uint32_t buffer);

  ScanPlan plan_;
  std::optional<std::uint64_t> most_volumes_;
  SweepTracker sweeps_;
  std::array<PendingVolume, pool_size> pending_;
  std::vector<std::uint32_t> free_; // buffers of the pool to build in
  std::vector<BScanJob> to_submit_; // what the last decision says
  std::uint64_t last_number_ = 0;
  hal::TimePoint next_tick_;
  Counts counts_;
};

} // namespace octascope::pipeline
