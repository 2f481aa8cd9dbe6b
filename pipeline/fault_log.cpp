#include "pipeline/fault_log.h"

#include <algorithm>

namespace octascope::pipeline {

void FaultLog::add(std::string_view device, std::string_view kind, std::string_view message,
                   hal::TimePoint when, std::uint64_t count) {
  const std::lock_guard lock{mutex_};
  const auto same = std::find_if(records_.begin(), records_.end(), [&](const FaultRecord& r) {
    return r.device == device && r.kind == kind;
  });
  if (same != records_.end()) {
    same->count += count;
    same->last = when;
    return;
  }
  records_.push_back(
      {std::string{device}, std::string{kind}, std::string{message}, count, when, when});
}

std::vector<FaultRecord> FaultLog::records() const {
  const std::lock_guard lock{mutex_};
  return records_;
}

} // namespace octascope::pipeline
