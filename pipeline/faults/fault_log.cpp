#include "pipeline/faults/fault_log.h"

#include <algorithm>

namespace octascope::pipeline {

namespace {

void count_in(FaultRecord& record, hal::TimePoint when, std::uint64_t count) {
  record.count += count;
  record.last = when;
}

} // namespace

void FaultLog::add(std::string_view device, std::string_view kind, std::string_view message,
                   hal::TimePoint when, std::uint64_t count) {
  const std::lock_guard lock{mutex_};
  if (FaultRecord* const known = find(device, kind))
    count_in(*known, when, count);
  else
    records_.push_back(
        {std::string{device}, std::string{kind}, std::string{message}, count, when, when});
}

bool FaultLog::add_to_known(std::string_view device, std::string_view kind, hal::TimePoint when,
                            std::uint64_t count) {
  const std::lock_guard lock{mutex_};
  FaultRecord* const known = find(device, kind);
  if (known != nullptr)
    count_in(*known, when, count);
  return known != nullptr;
}

FaultRecord* FaultLog::find(std::string_view device, std::string_view kind) {
  const auto same = std::ranges::find_if(
      records_, [&](const FaultRecord& r) { return r.device == device && r.kind == kind; });
  return same == records_.end() ? nullptr : &*same;
}

std::vector<FaultRecord> FaultLog::records() const {
  const std::lock_guard lock{mutex_};
  return records_;
}

} // namespace octascope::pipeline
