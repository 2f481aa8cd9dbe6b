// Is the monitor still there? By the kernel's hot-plug events, and by the connector's status in
// /sys for drivers that send none.
#pragma once

#include <optional>
#include <string>

#include "hal/linux/kms/drm/topology.h"
#include "hal/linux/system/device_watch.h"
#include "hal/linux/system/file_descriptor.h"

namespace octascope::hal::linux_backend::kms {

// Threads: one at a time.
class ConnectorWatch {
public:
  // Works as far as it can where there is no /sys or no event socket.
  ConnectorWatch(const Card& card, const Connector& connector);

  // The monitor was there and is gone. Allocates nothing, waits for nothing.
  bool disconnected() const;

  // Has the card said since the last time that something about its outputs changed?
  bool changed();

private:
  const std::string node_;
  const bool was_connected_;
  FileDescriptor status_;
  std::optional<DeviceWatch> events_;
};

} // namespace octascope::hal::linux_backend::kms
