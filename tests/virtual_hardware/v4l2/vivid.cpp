#include "tests/virtual_hardware/v4l2/vivid.h"

#include <fcntl.h>
#include <linux/videodev2.h>

#include "hal/linux/system/system_error.h"
#include "hal/linux/v4l2/camera_settings.h"
#include "hal/linux/v4l2/capture_node.h"
#include "hal/linux/v4l2/video_nodes.h"

namespace octascope::tests {

using namespace hal::linux_backend;

std::optional<Vivid> Vivid::find() {
  for (const std::string& node : video_nodes()) {
    const auto opened = CaptureNode::open(node);
    if (opened && opened->identity().driver == "vivid")
      return Vivid{node};
  }
  return std::nullopt;
}

FileDescriptor Vivid::hold() const {
  auto file = open_device(node_, O_RDWR | O_NONBLOCK);
  return file ? std::move(*file) : FileDescriptor{};
}

void Vivid::reset() const {
  set("Percentage of Dropped Buffers", 0);
  set("Wrap Sequence Number", 0);
  set("Wrap Timestamp", 0);
  set("Timestamp Source", 0);
  int input = any_size_input;
  control(hold(), VIDIOC_S_INPUT, &input);
}

bool Vivid::set(std::string_view name, std::int64_t value) const {
  const FileDescriptor file = hold();
  CameraSettings settings;
  settings.others = {{std::string{name}, value}};
  return file && apply_settings(file, node_, settings, 1000, 1).has_value();
}

} // namespace octascope::tests
