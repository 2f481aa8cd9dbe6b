// The device nodes of a camera, which tell whether it is still plugged in.
#pragma once

#include <string>
#include <vector>

#include <sys/types.h>

namespace octascope::hal::linux_backend {

class CameraNodes {
public:
  CameraNodes() = default;
  explicit CameraNodes(std::vector<dev_t> nodes);

  // Whether the kernel still has all of them. An open node keeps its number, so a device that is
  // plugged in later is not mistaken for it. Does not allocate.
  bool present() const;
  bool include(dev_t node) const;
  // Redirects this process's descriptors of these nodes to /dev/null. The nodes are closed, but the
  // descriptor numbers are not reused while libcamera still refers to them.
  void shut() const;
  // Whether libcamera itself notices when this camera is unplugged: only with the driver uvcvideo.
  bool watched() const { return watched_; }

private:
  std::vector<dev_t> nodes_;
  std::vector<std::string> paths_; // in /sys
  bool watched_ = false;
};

} // namespace octascope::hal::linux_backend
