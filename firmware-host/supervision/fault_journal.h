// Writes faults to the system's journal without flooding it.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "hal/clock.h"
#include "pipeline/faults/fault_log.h"

namespace octascope::firmware_host {

// One message of the journal: fields as systemd.journal-fields(7) names them.
struct JournalEntry {
  int priority = 6; // as syslog(3) counts
  std::string message;
  std::optional<pipeline::Fault> fault{}; // OCTASCOPE_DEVICE, OCTASCOPE_FAULT
  std::uint64_t count = 0; // OCTASCOPE_COUNT: faults of the kind since the last message
};

// "PRIORITY=4", "MESSAGE=…" …
std::vector<std::string> to_fields(const JournalEntry& entry);
void send_to_journal(const JournalEntry& entry);

// Each kind of fault is logged when it first strikes and then at most every ten seconds, with its
// count. One thread.
class FaultJournal {
public:
  using Sink = std::function<void(const JournalEntry&)>;
  static constexpr hal::Duration least_pause = std::chrono::seconds{10};

  explicit FaultJournal(Sink sink) : sink_{std::move(sink)} {}

  void update(std::span<const pipeline::FaultRecord> faults, hal::TimePoint now);

private:
  struct Told {
    std::uint64_t count = 0; // 0: never
    hal::TimePoint at;
  };

  Sink sink_;
  std::array<Told, pipeline::fault_count> told_{};
};

} // namespace octascope::firmware_host
