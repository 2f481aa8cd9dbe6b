// What went wrong, for the report and for the notice line of the display.
#pragma once

#include <array>
#include <concepts>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "hal/clock.h"
#include "hal/result.h"
#include "pipeline/faults/fault.h"

namespace octascope::pipeline {

struct FaultRecord {
  Fault kind{};
  std::string message; // of the first one
  std::uint64_t count = 0;
  hal::TimePoint first;
  hal::TimePoint last;
};

// Each kind of fault is one record with a count, so a stream of them can neither fill the memory
// nor flood a log. Thread-safe. It locks, and it allocates the message of the first of a kind: it
// is called where something has gone wrong, never on the way of good data. A stream of faults
// allocates nothing where the message is made by a function, which the first alone calls.
class FaultLog {
public:
  // `count` faults of the kind at once, at least one.
  void add(Fault fault, std::string_view message, hal::TimePoint when, std::uint64_t count = 1);
  template <std::invocable MakeMessage>
  void add(Fault fault, MakeMessage&& message, hal::TimePoint when, std::uint64_t count = 1) {
    const std::string words = struck(fault) ? std::string{} : std::invoke(message);
    add(fault, std::string_view{words}, when, count);
  }
  // What a device answered.
  void add(Device device, const hal::Error& error, hal::TimePoint when) {
    add(fault_of(device, error.code), error.message, when);
  }
  // In the order in which each first struck.
  std::vector<FaultRecord> records() const;

private:
  bool struck(Fault fault) const;

  mutable std::mutex mutex_;
  std::array<FaultRecord, fault_count> records_{}; // count 0: it never struck
  std::array<Fault, fault_count> order_{};         // in which they struck first; `kinds_` of them
  std::size_t kinds_ = 0;
};

} // namespace octascope::pipeline
