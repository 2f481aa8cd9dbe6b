// What went wrong, for the report and for the notice line of the display.
#pragma once

#include <cstdint>
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
// kind: it is called where something has gone wrong, never on the way of good data.
class FaultLog {
public:
  // `count` faults of the kind at once.
  void add(std::string_view device, std::string_view kind, std::string_view message,
           hal::TimePoint when, std::uint64_t count = 1);
  std::vector<FaultRecord> records() const;

private:
  mutable std::mutex mutex_;
  std::vector<FaultRecord> records_;
};

} // namespace octascope::pipeline
