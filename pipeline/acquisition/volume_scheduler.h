// Decides, from times alone, which tick gets a trigger pulse, where each frame goes, when a B-scan
// is built from the sweeps that arrived, and when a volume is published or lost.
//
// B-scans are handed to the workers as they arrive, so that almost nothing is left to do after the
// last one. A volume is published when it is complete. Otherwise it is published, with its missing
// B-scans marked, shortly after its sweeps should have ended and once the camera thread has polled
// the camera up to then (or has failed to within a limited time). So a late camera never delays the
// tick, and a frame that the camera delivered in time does not count as late on a busy machine.
//
// A B-scan with several sweeps is built when all of them have arrived. If one is missing, it is
// built once a sweep of the B-scan after the next has arrived, or when the volume's time is over.
// It is missing if none of its sweeps arrived, and overdue as soon as it waits no longer.
//
// A volume may be passed over: its frames are placed and counted, and nothing is built of them.
#pragma once

#include <algorithm>
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

struct TickDecision {
  std::uint64_t slept_through = 0; // ticks missed before this one: lost volumes
  bool pulse = false;              // answer with pulsed(), pulse_failed() or not_ready()
};

enum class FrameVerdict : std::uint8_t {
  placed,
  passed_over, // of a volume that is
  outside,     // not exposed during any sweep of the last volumes
  doubled,     // of a sweep that already has a frame
  late         // its B-scan has been submitted, or its volume is over
};

// Where to put a frame, and which jobs to hand to the workers, in this order, once it is there. A
// frame that is not `placed` must be given back to the camera.
struct FrameDecision {
  FrameVerdict verdict = FrameVerdict::outside;
  std::uint32_t buffer = 0;
  int b_scan = 0;
  int repeat = 0;
  std::span<const BScanJob> submit{}; // valid until the next call
  // B-scans of `buffer` of which nothing came in time, for the first time; likewise.
  std::span<const int> overdue{};
};

struct FinishedVolume {
  std::uint64_t number = 0; // of its tick, from 1: those that brought no pulse are counted, too
  hal::TimePoint first_line{}, last_line{}; // of the first frame to arrive; the latest of all
  std::int32_t lost_b_scans = 0, lost_lines = 0;
};

// What to do with the oldest volume under way, or with one that is passed over.
struct VolumeDecision {
  enum class Action : std::uint8_t {
    wait,    // until next_wake(), a frame, a finished B-scan, or a poll by the camera thread
    look,    // ask the camera thread to poll the camera up to `look_until`
    submit,  // hand `submit` to the workers: the missing sweeps of these B-scans will not come
    publish, // `buffer` will not get any more complete; publish it, then call published()
    pass,    // it was passed over; `buffer` is none of the pool
    lose     // nothing arrived; `buffer` is free again, if it is one of the pool
  };
  Action action = Action::wait;
  std::uint32_t buffer = 0;
  hal::TimePoint look_until{};
  std::span<const BScanJob> submit{}; // valid until the next call
  FinishedVolume volume{};            // publish, pass and lose
};

// Pure logic: no clock, no thread, no device. For one thread, unless stated otherwise. Allocates on
// construction only.
class VolumeScheduler {
public:
  // The triple buffer's middle, the renderer's, and three to build in.
  static constexpr std::uint32_t pool_size = 5;
  // The buffers that are initially in the middle and with the renderer.
  static constexpr std::uint32_t first_middle = 0, first_front = 1;

  // Asks for at most `most_volumes` volumes, if given.
  VolumeScheduler(const ScanPlan& plan, std::optional<std::uint64_t> most_volumes);

  // The first tick is due at `first`.
  void begin(hal::TimePoint first) { next_tick_ = first; }
  bool tick_due(hal::TimePoint now) const { return now >= next_tick_; }
  TickDecision tick(hal::TimePoint now);

  // The pulse was sent. Returns the buffer to build its volume in, never `lent`, or nothing if the
  // workers are three volumes behind: the volume is then lost.
  std::optional<std::uint32_t> pulsed(hal::TimePoint when, std::optional<std::uint32_t> lent = {});
  // The pulse was sent, and nothing is to be built of its volume. Takes no buffer of the pool.
  void pass_over(hal::TimePoint when);
  // Whether a volume is under way that is not passed over.
  bool is_building() const {
    return std::ranges::any_of(std::span{pending_}.first(pool_size), &PendingVolume::open);
  }
  // Of the volume that is built in it.
  std::uint64_t number_of(std::uint32_t buffer) const { return pending_[buffer].facts.number; }
  void pulse_failed();
  // Camera or trigger is not available. Counts a lost volume, except before the first pulse.
  void not_ready();

  // Places a good frame by the camera's time stamps.
  FrameDecision place(hal::TimePoint first_line, hal::TimePoint last_line);

  // Any thread: a submitted B-scan of this buffer is built. Whatever the thread wrote before is
  // visible when the volume is published. True: the thread may have nothing else to wait for in this
  // volume, and is to be woken.
  bool b_scan_made(std::uint32_t buffer) {
    PendingVolume& volume = pending_[buffer];
    volume.made.fetch_add(1); // in one order with the flag: one of the two sees the other
    return volume.awaits_workers.load();
  }

  // Call repeatedly until it returns `wait`. `looked_until`: Acquisition::looked_until(), read
  // before taking the frames placed so far. `streaming`: whether the camera streams.
  VolumeDecision next(hal::TimePoint now, hal::TimePoint looked_until, bool streaming);

  // The volume was published in exchange for buffer `recycled`; `skipped` if that one was never
  // taken.
  void published(std::uint32_t recycled, bool skipped);

  void count_saturated_lines(std::int32_t lines) { count(counts_.saturated_lines, lines); }

  // When the thread must wake at the latest, even if nothing happens. May be in the past: then
  // something, such as a tick, has come due since the last check.
  hal::TimePoint next_wake(hal::TimePoint now) const;

  // Counts the volumes under way as unfinished.
  void end() { counts_.unfinished.store(under_way(), std::memory_order_relaxed); }

  // Any thread.
  VolumeCounters counters() const;

private:
  struct BScanSlot {
    std::uint32_t came = 0; // one bit per repeat
    bool submitted = false; // from then on the worker owns the frames
  };
  struct PendingVolume {
    bool open = false;
    FinishedVolume facts; // so far
    hal::TimePoint accept_until;
    std::optional<hal::TimePoint> give_up_at; // set if the camera was not polled that long
    std::vector<BScanSlot> slots;             // by B-scan
    int sweeps_came = 0;
    int submitted = 0;
    int flushed = 0;                         // B-scans before this one no longer wait for sweeps
    std::atomic<int> made{0};                // B-scans that the workers are done with
    std::atomic<bool> awaits_workers{false}; // and nothing else
  };
  struct Counts {
    std::atomic<std::uint64_t> planned{0}, triggered{0}, acquired{0}, published{0}, skipped{0},
        passed_over{0}, lost_lines{0}, lost_b_scans{0}, lost_volumes{0}, unfinished{0},
        saturated_lines{0};
  };

  static void count(std::atomic<std::uint64_t>& counter, std::int64_t by = 1) {
    counter.fetch_add(static_cast<std::uint64_t>(by), std::memory_order_relaxed);
  }
  // Whether it still waits for sweeps, not only for the workers.
  bool awaits_sweeps(const PendingVolume& volume) const;
  void count_lost_volume();
  std::uint64_t under_way() const;
  hal::TimePoint begin_pulse(hal::TimePoint when);
  void open(PendingVolume& volume, hal::TimePoint end);
  static bool is_passed_over(std::uint32_t place) { return place >= pool_size; }
  std::optional<std::uint32_t> find(std::uint64_t number) const;
  std::optional<std::uint32_t> oldest(std::uint32_t begin, std::uint32_t end) const;
  std::optional<std::uint32_t> oldest_built() const;
  std::optional<std::uint32_t> oldest_passed_over() const;
  VolumeDecision next_of(std::uint32_t buffer, hal::TimePoint now, hal::TimePoint looked_until,
                         bool streaming);
  void submit(std::uint32_t buffer, int b_scan);
  void flush(std::uint32_t buffer, int end);
  VolumeDecision finish(std::uint32_t buffer);
  static int b_scans_without_sweep(const PendingVolume& volume);

  ScanPlan plan_;
  std::optional<std::uint64_t> most_volumes_;
  SweepTracker sweeps_;
  std::array<PendingVolume, pool_size + SweepTracker::volumes>
      pending_;                     // of each buffer; passed over
  std::vector<std::uint32_t> free_; // buffers of the pool to build in
  std::vector<BScanJob> to_submit_; // jobs of the last decision
  std::vector<int> overdue_;        // likewise
  std::uint64_t last_number_ = 0;   // of the last pulse; 0: none yet
  hal::TimePoint next_tick_;
  Counts counts_;
};

} // namespace octascope::pipeline
