#include "firmware-host/report/notice.h"

#include <algorithm>
#include <optional>

namespace octascope::firmware_host {

namespace {

bool is_away(hal::DeviceState state) {
  return state == hal::DeviceState::absent || state == hal::DeviceState::failed;
}

// By what its newest fault says.
std::string_view notice_of_away(pipeline::Device device,
                                std::span<const pipeline::FaultRecord> faults) {
  const pipeline::FaultRecord* newest = nullptr;
  for (const pipeline::FaultRecord& record : faults)
    if (facts_of(record.kind).device == device && (newest == nullptr || newest->last < record.last))
      newest = &record;
  const bool denied = newest != nullptr && newest->kind == fault_of(device, hal::ErrorCode::denied);
  return denied ? facts_of(device).denied : facts_of(device).away;
}

} // namespace

std::string_view compose_notice(std::span<const pipeline::FaultRecord> faults,
                                std::span<const ui::DeviceStatus> devices, hal::TimePoint now) {
  std::optional<pipeline::Device> away;
  for (const ui::DeviceStatus& device : devices) {
    // Without a fault, a device that is not open has not been opened yet.
    const bool faulty = std::ranges::any_of(faults, [&](const pipeline::FaultRecord& record) {
      return facts_of(record.kind).device == device.device;
    });
    if (is_away(device.state) && faulty && !facts_of(device.device).away.empty())
      away = std::min(away.value_or(device.device), device.device);
  }
  if (away)
    return notice_of_away(*away, faults);
  std::optional<pipeline::FaultFacts> gravest;
  for (const pipeline::FaultRecord& record : faults) {
    const pipeline::FaultFacts facts = facts_of(record.kind);
    if (!facts.notice.empty() && now - record.last <= facts.shown_for &&
        (!gravest || facts.fault < gravest->fault))
      gravest = facts;
  }
  return gravest ? gravest->notice : std::string_view{};
}

} // namespace octascope::firmware_host
