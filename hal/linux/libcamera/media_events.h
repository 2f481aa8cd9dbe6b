// What libcamera's own watch over devices hears: media devices alone.
//
// When udev tells of a video node, libcamera (0.0.3, DeviceEnumeratorUdev::addV4L2Device) looks up the media
// device that waited for it by a pointer that it keeps after that device was complete and forgotten. A node
// that is told of a second time, as by `udevadm trigger --action=add`, by a camera that is plugged in again,
// or at start-up, therefore ends the program.
#pragma once

#include "hal/result.h"

namespace octascope::hal::linux_backend {

// From now on no event of a video node reaches a watch of this process that listens to media devices and
// video nodes, as libcamera's does. It still hears of media devices that are unplugged; of cameras that are
// plugged in it does not learn. Returns how many watches there were. Thread-safe.
Result<int> keep_video_nodes_from_libcamera();

} // namespace octascope::hal::linux_backend
