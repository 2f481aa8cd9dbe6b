// The line camera on GenICam: USB3 Vision and GigE Vision, by Aravis. What is asked of here is one
// camera by its name; nothing else on a bus or a network is opened. USB3 Vision has not been tried
// with a camera yet.
//
// A frame is an image of samples_per_line × lines_per_frame pixels. Packed samples are unpacked on a
// thread of the camera's own, as are samples of another depth brought to the format's.
//
// Faults, in addition to those of hal::LineCamera:
// - Aravis is not installed, or was not when octascope was built: open() is refused with
//   ErrorCode::unsupported and the remedy.
// - Packets are lost and not sent again in time: FrameIntegrity::corrupted. What was not received
//   of the frame is left from an older one, and it is not unpacked.
// - A GigE camera that goes is noticed by its heartbeat, some seconds later.
// - Aravis waits seconds for a camera that does not answer; nobody waits for Aravis longer than a
//   second: open() and start() say ErrorCode::absent, and the next one has what came of it meanwhile;
//   stop() leaves `failed`; what is left after close() and at the end ends by itself.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hal/clock.h"
#include "hal/line_camera.h"
#include "hal/linux/aravis/genicam_address.h"
#include "hal/linux/aravis/genicam_pixels.h"
#include "hal/result.h"

namespace octascope::hal::linux_backend {

struct GenicamCameraOptions {
  GenicamAddress address = {};
  std::optional<double> exposure_us = {}; // empty: unchanged, as are the next two
  std::optional<double> gain = {};        // in the camera's own unit
  std::string trigger = {};               // the source that starts a frame: "Line1", "Software"
  bool packet_resend = true;              // GigE Vision: ask for lost packets again
  // Depths::any: a camera without a format of the wanted depth is taken, too, its samples scaled from
  // full scale to full scale; else it is refused.
  Depths depths = Depths::wanted;
};

// `clock` is borrowed, must outlive the camera and must run on CLOCK_MONOTONIC.
std::unique_ptr<LineCamera> make_genicam_camera(GenicamCameraOptions options, Clock& clock);

struct GenicamFinding {
  std::string camera; // vendor, model and serial number
  std::vector<std::string> pixel_formats;
};

// Opens the camera, asks it and closes it again. Errors as of open().
Result<GenicamFinding> find_genicam_camera(const GenicamAddress& address);

} // namespace octascope::hal::linux_backend
