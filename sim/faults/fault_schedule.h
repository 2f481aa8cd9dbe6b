// Decides when which fault is active: pure logic over a FaultScript and explicit times.
//
// Immutable except for its zero of time, so any thread may query it at any moment, without a lock
// or an allocation. Simulated devices that are only present or absent (scope camera, display) need
// only active(); those that count frames or pulses use a FaultProbe.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "hal/clock.h"
#include "sim/faults/fault_script.h"

namespace octascope::sim {

// The beginning or end of a fault, for reports. Points into the schedule.
struct FaultEdge {
  hal::TimePoint time;
  const ScriptedFault* fault = nullptr;
  bool begins = true;
};

// One occurrence of a repeated fault.
struct FaultOccurrence {
  std::uint64_t index = 0;
  hal::TimePoint began;
};

class FaultSchedule {
public:
  explicit FaultSchedule(FaultScript script) : script_(std::move(script)) {}

  // Sets time zero, from any thread. No fault is active before the first start().
  void start(hal::TimePoint zero) {
    zero_ns_.store(zero.time_since_epoch().count(), std::memory_order_release);
  }

  std::span<const ScriptedFault> faults() const { return script_.faults; }

  // The occurrence of one of faults() at time `t`. A fault that only a count ends lasts until its
  // next occurrence; the caller, which counts, knows when it is used up.
  std::optional<FaultOccurrence> occurrence(const ScriptedFault& fault, hal::TimePoint t) const;

  // Whether a fault of this kind is active at time `t`.
  bool active(pipeline::Fault kind, hal::TimePoint t) const {
    return find_active(kind, t) != nullptr;
  }
  // The first active one in the script, or null. With switch_index ≥ 0: only faults of that switch
  // and of all switches.
  const ScriptedFault* find_active(pipeline::Fault kind, hal::TimePoint t,
                                   int switch_index = -1) const;

  // The first beginning or end of such a fault after `after`.
  std::optional<hal::TimePoint> next_edge(pipeline::Fault kind, hal::TimePoint after) const;

  // Whether a fault of this kind began in (after, until]; for devices that might miss a short one.
  bool began_within(pipeline::Fault kind, hal::TimePoint after, hal::TimePoint until) const;

  // Every beginning and end of all devices in (after, until], oldest first. Returns the number
  // written. When `edges` is full, call again with the last one's time.
  std::size_t edges_within(hal::TimePoint after, hal::TimePoint until,
                           std::span<FaultEdge> edges) const;

private:
  static constexpr std::int64_t not_started = INT64_MAX;

  std::optional<FaultEdge> next_edge_of(const ScriptedFault& fault, hal::TimePoint after) const;

  FaultScript script_;
  std::atomic<std::int64_t> zero_ns_{not_started};
};

} // namespace octascope::sim
