// The device nodes that a camera is made of: whether it is still plugged in.
#pragma once

#include <string>
#include <vector>

#include <sys/types.h>

namespace octascope::hal::linux_backend {

class CameraNodes {
public:
  CameraNodes() = default;
  explicit CameraNodes(std::vector<dev_t> nodes);

  // The kernel has all of them. A node that is held open keeps its number, so another device that
  // comes meanwhile is not taken for it. Allocates nothing.
  bool present() const;
  bool include(dev_t node) const;
  // Closes what this process has open of them, in such a way that their numbers are not given to
  // other files: whoever still names one finds nothing behind it.
  void shut() const;
  // Libcamera notices by itself when this camera goes: it does for those of the driver uvcvideo.
  bool watched() const { return watched_; }

private:
  std::vector<dev_t> nodes_;
  std::vector<std::string> paths_; // in /sys
  bool watched_ = false;
};

} // namespace octascope::hal::linux_backend
