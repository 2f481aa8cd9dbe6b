// Detects when the monitor is disconnected: from the kernel's hot-plug events, and from the
// connector's status in /sys for drivers that send none.
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
  // Without /sys or without an event socket, it uses the other one.
  ConnectorWatch(const Card& card, const Connector& connector);

  // The monitor was connected at construction and no longer is. Neither allocates nor waits.
  bool disconnected() const;

  // Whether the card has reported a change of its outputs since the last call.
  bool changed();

private:
  const std::string node_;
  const bool was_connected_;
  FileDescriptor status_;
  std::optional<DeviceWatch> events_;
};

} // namespace octascope::hal::linux_backend::kms
