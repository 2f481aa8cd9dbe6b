// What libcamera's own watch over devices hears: media devices alone.
//
// When udev tells of a video node, libcamera (0.0.3, DeviceEnumeratorUdev::addV4L2Device) looks up the media
// device that waited for it by a pointer that it keeps after that device was complete and forgotten. A node
// that is told of a second time, as by `udevadm trigger --action=add`, by a camera that is plugged in again,
// or at start-up, therefore ends the program.
#pragma once

namespace libcamera {
class CameraManager;
} // namespace libcamera

namespace octascope::hal::linux_backend {

// Starts it, so that no event of a video node ever reaches it: its wish to hear of them, which it tells libudev
// while it starts, is dropped. It still hears of media devices that are unplugged; of cameras that are plugged
// in it does not learn. Returns what libcamera's start does. Thread-safe.
int start_without_video_nodes(libcamera::CameraManager& manager);

} // namespace octascope::hal::linux_backend
