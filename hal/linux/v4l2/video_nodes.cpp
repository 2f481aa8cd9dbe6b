#include "hal/linux/v4l2/video_nodes.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "hal/linux/system/system_files.h"

namespace octascope::hal::linux_backend {

namespace fs = std::filesystem;

std::vector<std::string> video_nodes(const fs::path& dev) {
  return numbered_entries(dev, "video");
}

LineCameraCandidate assess_line_camera(const std::string& node, const LineFormat& wanted) {
  LineCameraCandidate candidate;
  candidate.identity.node = node;
  const auto opened = CaptureNode::open(node);
  if (!opened) {
    candidate.unsuitable = opened.error();
    return candidate;
  }
  candidate.captures = true;
  candidate.identity = opened->identity();
  if (const auto offered = opened->formats())
    candidate.formats = words(*offered);
  if (const auto chosen = opened->choose_format(wanted); !chosen)
    candidate.unsuitable = chosen.error();
  return candidate;
}

std::vector<LineCameraCandidate> line_camera_candidates(const LineFormat& wanted) {
  std::vector<LineCameraCandidate> candidates;
  for (const std::string& node : video_nodes())
    candidates.push_back(assess_line_camera(node, wanted));
  return candidates;
}

Result<std::string> pick_line_camera(const std::vector<LineCameraCandidate>& candidates,
                                     const std::string& bus, const LineFormat& wanted) {
  const LineCameraCandidate* first = nullptr;
  const Error* denial = nullptr; // one tells for all
  int denied = 0;
  std::string reasons;
  for (const LineCameraCandidate& candidate : candidates) {
    if (candidate.suits()) {
      if (!bus.empty() && candidate.identity.bus == bus)
        return candidate.identity.node;
      if (first == nullptr)
        first = &candidate;
    } else if (candidate.unsuitable->code == ErrorCode::denied) {
      denial = denial != nullptr ? denial : &*candidate.unsuitable;
      ++denied;
    } else if (candidate.captures) {
      reasons += "; " + candidate.unsuitable->message;
    }
  }
  if (first != nullptr)
    return first->identity.node;
  if (denial != nullptr)
    reasons += fmt::format("; {} of them may not be opened: {}", denied, denial->message);
  return fail(denial != nullptr ? ErrorCode::denied : ErrorCode::absent,
              "no line camera among {} video devices, expected one with {}{}", candidates.size(),
              words(wanted), reasons.empty() ? "; check its plug and its driver" : reasons);
}

} // namespace octascope::hal::linux_backend
