#include "firmware-host/supervision/fault_journal.h"

#include <fmt/format.h>
#include <sys/uio.h>
#include <syslog.h>
#include <systemd/sd-journal.h>

namespace octascope::firmware_host {

std::vector<std::string> to_fields(const JournalEntry& entry) {
  std::vector<std::string> fields{fmt::format("PRIORITY={}", entry.priority),
                                  "MESSAGE=" + entry.message};
  if (entry.fault) {
    const pipeline::FaultFacts facts = facts_of(*entry.fault);
    fields.push_back(fmt::format("OCTASCOPE_DEVICE={}", facts.device_key()));
    fields.push_back(fmt::format("OCTASCOPE_FAULT={}", facts.key));
    fields.push_back(fmt::format("OCTASCOPE_COUNT={}", entry.count));
  }
  return fields;
}

void send_to_journal(const JournalEntry& entry) {
  std::vector<std::string> fields = to_fields(entry);
  std::vector<iovec> pieces;
  for (std::string& field : fields)
    pieces.push_back({field.data(), field.size()});
  sd_journal_sendv(pieces.data(), static_cast<int>(pieces.size()));
}

void FaultJournal::update(std::span<const pipeline::FaultRecord> faults, hal::TimePoint now) {
  for (const pipeline::FaultRecord& fault : faults) {
    Told& told = told_[index_of(fault.kind)];
    if (fault.count == told.count || (told.count > 0 && now - told.at < least_pause))
      continue;
    const std::uint64_t count = fault.count - told.count;
    told = {fault.count, now};
    // More than one: how often it struck since it was told last.
    const pipeline::FaultFacts facts = facts_of(fault.kind);
    sink_({LOG_WARNING,
           fmt::format("{} {}{}: {}", facts.device_key(), facts.key,
                       count > 1 ? fmt::format(" ×{}", count) : "", fault.message),
           fault.kind, count});
  }
}

} // namespace octascope::firmware_host
