#include "hal/linux/libcamera/camera_nodes.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

#include "hal/linux/system/file_descriptor.h"

namespace octascope::hal::linux_backend {

CameraNodes::CameraNodes(std::vector<dev_t> nodes) : nodes_{std::move(nodes)} {
  for (const dev_t node : nodes_)
    paths_.push_back(fmt::format("/sys/dev/char/{}:{}", major(node), minor(node)));
  watched_ = !paths_.empty() && std::ranges::all_of(paths_, [](const std::string& path) {
    std::error_code error;
    return std::filesystem::read_symlink(path + "/device/driver", error).filename() == "uvcvideo";
  });
}

bool CameraNodes::present() const {
  return std::ranges::all_of(
      paths_, [](const std::string& path) { return ::access(path.c_str(), F_OK) == 0; });
}

bool CameraNodes::include(dev_t node) const {
  return std::ranges::find(nodes_, node) != nodes_.end();
}

void CameraNodes::shut() const {
  const FileDescriptor nothing{::open("/dev/null", O_RDWR | O_CLOEXEC)};
  if (!nothing)
    return;
  std::error_code error;
  std::vector<int> open_nodes; // first, as the folder changes with them
  for (std::filesystem::directory_iterator it{"/proc/self/fd", error}, end; !error && it != end;
       it.increment(error)) {
    const int number = std::atoi(it->path().filename().c_str());
    struct stat status {};
    if (::fstat(number, &status) == 0 && S_ISCHR(status.st_mode) && include(status.st_rdev))
      open_nodes.push_back(number);
  }
  for (const int number : open_nodes)
    ::dup3(nothing.get(), number, O_CLOEXEC);
}

} // namespace octascope::hal::linux_backend
