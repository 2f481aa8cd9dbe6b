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

} // namespace octascope::hal
