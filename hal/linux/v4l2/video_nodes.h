// Lists the video nodes and those that can serve as the line camera: for `devices`, for `doctor`,
// and for choosing between the real and the simulated camera.
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
  NodeIdentity identity; // card, driver and bus are empty if the node could not be queried
  std::string formats;   // "Y12 320×180 to 4096×2160, GREY": the formats offered, for people
  bool captures = false; // it is a capture device
  std::optional<Error> unsuitable; // why it cannot serve as the line camera; empty: it can

  bool suits() const { return !unsuitable.has_value(); }
};

// "/dev/video0", "/dev/video2" …, by number.
std::vector<std::string> video_nodes(const std::filesystem::path& dev = "/dev");

// Opens and queries the node; changes nothing and does not disturb a running stream.
LineCameraCandidate assess_line_camera(const std::string& node, const LineFormat& wanted);

// All video nodes, assessed. Allocates, takes milliseconds; any thread.
std::vector<LineCameraCandidate> line_camera_candidates(const LineFormat& wanted);

// The node to open: the first suitable one, preferably on `bus` (empty: no preference). If there is
// none: ErrorCode::denied if nodes could not be opened for lack of permission, else
// ErrorCode::absent; the message lists each camera and why it is unsuitable. Pure.
Result<std::string> pick_line_camera(const std::vector<LineCameraCandidate>& candidates,
                                     const std::string& bus, const LineFormat& wanted);

} // namespace octascope::hal::linux_backend
