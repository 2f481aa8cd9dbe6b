// When which fault strikes: pure logic over a FaultScript and explicit times.
//
// Immutable but for its time zero, so any thread may ask at any time, without a lock or an
// allocation. Twins that only need to know whether they are plugged in (scope camera, display) use
// active(); those that count frames or pulses use a FaultProbe.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "hal/clock.h"
#include "sim/faults/fault_script.h"

namespace octascope::sim {

// The beginning or end of a fault; for reports. Points into the schedule.
struct FaultEdge {
  hal::TimePoint time;
  const ScriptedFault* fault = nullptr;
  bool begins = true;
};

// One repetition of a fault.
struct FaultOccurrence {
  std::uint64_t index = 0;
  hal::TimePoint began;
};

class FaultSchedule {
public:
  explicit FaultSchedule(FaultScript script) : script_(std::move(script)) {}

  // Sets time zero, from any thread. Before the first start() no fault is active.
  void start(hal::TimePoint zero) {
    zero_ns_.store(zero.time_since_epoch().count(), std::memory_order_release);
  }

  std::span<const ScriptedFault> faults() const { return script_.faults; }

  // The occurrence of one of faults() at time `t`. One that is ended only by a count lasts until
  // the next begins: the counter knows when it is spent.
  std::optional<FaultOccurrence> occurrence(const ScriptedFault& fault, hal::TimePoint t) const;

  // Whether a fault of this kind is active at time `t`.
  bool active(pipeline::Fault kind, hal::TimePoint t) const {
    return find_active(kind, t) != nullptr;
  }
  // The first active one in the script, or null. With switch_index ≥ 0: only faults of that switch
  // or of all switches.
  const ScriptedFault* find_active(pipeline::Fault kind, hal::TimePoint t,
                                   int switch_index = -1) const;

  // The first beginning or end of such a fault later than `after`.
  std::optional<hal::TimePoint> next_edge(pipeline::Fault kind, hal::TimePoint after) const;

  // Whether a fault of this kind began after `after` and no later than `until`: for a twin that did
  // not look while a short one came and went.
  bool began_within(pipeline::Fault kind, hal::TimePoint after, hal::TimePoint until) const;

  // Every beginning and end, of all devices, after `after` and no later than `until`, oldest first;
  // returns the number written. If `edges` is full, ask again from the last one's time.
  std::size_t edges_within(hal::TimePoint after, hal::TimePoint until,
                           std::span<FaultEdge> edges) const;

private:
  static constexpr std::int64_t not_started = INT64_MAX;

  std::optional<FaultEdge> next_edge_of(const ScriptedFault& fault, hal::TimePoint after) const;

  FaultScript script_;
  std::atomic<std::int64_t> zero_ns_{not_started};
};

} // namespace octascope::sim
