// Which video nodes there are, and which of them can serve as the line camera: for `devices`, for
// `doctor`, and for the choice between the camera and its twin.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "hal/line_camera.h"
#include "hal/linux/v4l2/capture_node.h"
#include "hal/result.h"

namespace octascope::hal::linux_backend {

struct LineCameraCandidate {
  NodeIdentity identity; // card, driver and bus are empty where the node could not be asked
  std::string formats;   // "Y12 320×180 to 4096×2160, GREY": what it offers, for people
  bool captures = false; // it brings pictures at all
  std::optional<Error> unsuitable; // nothing: it can serve; else why not

  bool suits() const { return !unsuitable.has_value(); }
};

// "/dev/video0", "/dev/video2" …, by their numbers.
std::vector<std::string> video_nodes(const std::filesystem::path& dev = "/dev");

// Opens the node and asks; changes nothing, and disturbs no stream.
LineCameraCandidate assess_line_camera(const std::string& node, const LineFormat& wanted);

// All of them. Allocates, takes milliseconds; any thread.
std::vector<LineCameraCandidate> line_camera_candidates(const LineFormat& wanted);

// The one to open: the first that suits, one on `bus` before others (empty: no preference).
// ErrorCode::denied where nodes could not be opened for want of permission, else ErrorCode::absent;
// the message has each camera and why it does not serve. Pure.
Result<std::string> pick_line_camera(const std::vector<LineCameraCandidate>& candidates,
                                     const std::string& bus, const LineFormat& wanted);

} // namespace octascope::hal::linux_backend
