#include "pipeline/faults/fault_log.h"

#include <span>

#include "hal/plain_text.h"

namespace octascope::pipeline {

void FaultLog::add(Fault fault, std::string_view message, hal::TimePoint when,
                   std::uint64_t count) {
  const std::lock_guard lock{mutex_};
  FaultRecord& record = records_[index_of(fault)];
  if (record.count == 0) {
    record = {fault, hal::printable_lines(message), 0, when, when};
    order_[kinds_++] = fault;
  }
  record.count += count;
  record.last = when;
}

bool FaultLog::struck(Fault fault) const {
  const std::lock_guard lock{mutex_};
  return records_[index_of(fault)].count > 0;
}

std::vector<FaultRecord> FaultLog::records() const {
  const std::lock_guard lock{mutex_};
  std::vector<FaultRecord> records;
  records.reserve(kinds_);
  for (const Fault fault : std::span{order_}.first(kinds_))
    records.push_back(records_[index_of(fault)]);
  return records;
}

} // namespace octascope::pipeline
