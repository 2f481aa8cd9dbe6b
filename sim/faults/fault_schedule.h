// When which fault strikes: pure logic over a FaultScript and explicit times.
//
// Immutable but for its zero of time, so any thread may ask, at any moment, without a lock or an
// allocation. Twins that know only "is it there?" (scope camera, display) need no more than
// active(); the twins that count frames or pulses look through a FaultProbe.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "hal/clock.h"
#include "sim/faults/fault_script.h"

namespace octascope::sim {

// A fault that begins or ends; for reports. Points into the schedule.
struct FaultEdge {
  hal::TimePoint time;
  const ScriptedFault* fault = nullptr;
  bool begins = true;
};

// One of the times that a fault comes round.
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

  // The occurrence of one of faults() that runs at time `t`. One that only a count ends runs until
  // the next begins: whoever counts knows when it is spent.
  std::optional<FaultOccurrence> occurrence(const ScriptedFault& fault, hal::TimePoint t) const;

  // Is a fault of this kind running at time `t`?
  bool active(pipeline::Fault kind, hal::TimePoint t) const {
    return find_active(kind, t) != nullptr;
  }
  // The first in the script that is, or null. With a switch_index from 0: only faults of that
  // switch and of all switches.
  const ScriptedFault* find_active(pipeline::Fault kind, hal::TimePoint t,
                                   int switch_index = -1) const;

  // The first beginning or end of such a fault later than `after`.
  std::optional<hal::TimePoint> next_edge(pipeline::Fault kind, hal::TimePoint after) const;

  // Has a fault of this kind begun later than `after` and not later than `until`? For the twin that
  // was not looking while a short one came and went.
  bool began_within(pipeline::Fault kind, hal::TimePoint after, hal::TimePoint until) const;

  // Every beginning and end, of all devices, later than `after` and not later than `until`, oldest
  // first; returns the number written. When `edges` is full, ask again from the last one's time.
  std::size_t edges_within(hal::TimePoint after, hal::TimePoint until,
                           std::span<FaultEdge> edges) const;

private:
  static constexpr std::int64_t not_started = INT64_MAX;

  std::optional<FaultEdge> next_edge_of(const ScriptedFault& fault, hal::TimePoint after) const;

  FaultScript script_;
  std::atomic<std::int64_t> zero_ns_{not_started};
};

} // namespace octascope::sim
