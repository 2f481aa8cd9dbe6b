// Collects faults for the report and for the notice line of the display.
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
  std::string message; // of the first occurrence
  std::uint64_t count = 0;
  hal::TimePoint first;
  hal::TimePoint last;
};

// Each kind of fault is one record with a count, so a stream of faults can neither fill the memory
// nor flood a log. Thread-safe. It locks, and allocates the message of the first fault of a kind:
// call it only when something has gone wrong, never in the path of good data. If the message is
// made by a function, only the first fault of a kind calls it; later ones do not allocate.
class FaultLog {
public:
  // Adds `count` faults of one kind, at least one.
  void add(Fault fault, std::string_view message, hal::TimePoint when, std::uint64_t count = 1);
  template <std::invocable MakeMessage>
  void add(Fault fault, MakeMessage&& message, hal::TimePoint when, std::uint64_t count = 1) {
    const std::string words = struck(fault) ? std::string{} : std::invoke(message);
    add(fault, std::string_view{words}, when, count);
  }
  // Adds an error returned by a device.
  void add(Device device, const hal::Error& error, hal::TimePoint when) {
    add(fault_of(device, error.code), error.message, when);
  }
  // In order of first occurrence.
  std::vector<FaultRecord> records() const;

private:
  bool struck(Fault fault) const;

  mutable std::mutex mutex_;
  std::array<FaultRecord, fault_count> records_{}; // count 0: never occurred
  std::array<Fault, fault_count> order_{};         // by first occurrence; `kinds_` entries are used
  std::size_t kinds_ = 0;
};

} // namespace octascope::pipeline
