#include "hal/linux/libcamera/camera_nodes.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include <fmt/format.h>
#include <sys/sysmacros.h>
#include <unistd.h>

namespace octascope::hal::linux_backend {

CameraNodes::CameraNodes(std::vector<dev_t> nodes) : nodes_{std::move(nodes)} {
  for (const dev_t node : nodes_)
    paths_.push_back(fmt::format("/sys/dev/char/{}:{}", major(node), minor(node)));
  watched_ =
      !paths_.empty() && std::all_of(paths_.begin(), paths_.end(), [](const std::string& path) {
        std::error_code error;
        return std::filesystem::read_symlink(path + "/device/driver", error).filename() ==
               "uvcvideo";
      });
}

bool CameraNodes::present() const {
  return std::all_of(paths_.begin(), paths_.end(),
                     [](const std::string& path) { return ::access(path.c_str(), F_OK) == 0; });
}

bool CameraNodes::include(dev_t node) const {
  return std::find(nodes_.begin(), nodes_.end(), node) != nodes_.end();
}

} // namespace octascope::hal::linux_backend
