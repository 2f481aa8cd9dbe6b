// What went wrong, for the report and for the notice line of the display.
#pragma once

#include <concepts>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "hal/clock.h"

namespace octascope::pipeline {

struct FaultRecord {
  std::string device;  // "line_camera", "galvo_trigger" …
  std::string kind;    // "disconnected", "corrupted_frame" …
  std::string message; // of the first one
  std::uint64_t count = 0;
  hal::TimePoint first;
  hal::TimePoint last;
};

// Faults of the same device and kind are one record with a count, so a stream of them can neither
// fill the memory nor flood a log. Thread-safe. It locks, and it allocates at the first fault of a
// kind: it is called where something has gone wrong, never on the way of good data. A stream of
// faults allocates nothing where the words are made by a function, which the first alone calls.
class FaultLog {
public:
  // `count` faults of the kind at once.
  void add(std::string_view device, std::string_view kind, std::string_view message,
           hal::TimePoint when, std::uint64_t count = 1);
  template <std::invocable MakeMessage>
  void add(std::string_view device, std::string_view kind, MakeMessage&& message,
           hal::TimePoint when, std::uint64_t count = 1) {
    if (add_to_known(device, kind, when, count))
      return;
    const std::string words = std::invoke(message);
    add(device, kind, std::string_view{words}, when, count);
  }
  std::vector<FaultRecord> records() const;

private:
  // False, and nothing done, at the first fault of a kind.
  bool add_to_known(std::string_view device, std::string_view kind, hal::TimePoint when,
                    std::uint64_t count);
  FaultRecord* find(std::string_view device, std::string_view kind); // with the mutex held

  mutable std::mutex mutex_;
  std::vector<FaultRecord> records_;
};

} // namespace octascope::pipeline
