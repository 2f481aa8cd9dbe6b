#include "hal/device.h"

namespace octascope::hal {

std::string_view to_string(DeviceState state) {
  switch (state) {
  case DeviceState::absent: return "absent";
  case DeviceState::ready: return "ready";
  case DeviceState::streaming: return "streaming";
  case DeviceState::failed: return "failed";
  }
  return "unknown";
}

Result<> Device::out_of_order(std::string_view kind, std::string_view call,
                              DeviceState expected) const {
  const DeviceState found = state();
  if (found == DeviceState::failed && expected != DeviceState::absent)
    return fail(ErrorCode::disconnected,
                "{} {}: {}() found it failed, expected {}; close it and open it again", backend(),
                kind, call, to_string(expected));
  return fail(ErrorCode::invalid_argument, "{} {}: {}() found it {}, expected {}", backend(), kind,
              call, to_string(found), to_string(expected));
}

} // namespace octascope::hal
