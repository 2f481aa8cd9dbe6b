#include "tests/virtual_hardware/support/loopback_feeder.h"

#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <fmt/format.h>
#include <linux/videodev2.h>
#include <unistd.h>

#include "hal/linux/system/system_error.h"
#include "hal/linux/v4l2/video_nodes.h"

namespace octascope::tests {

using namespace hal;
using namespace hal::linux_backend;

std::optional<std::string> LoopbackFeeder::find() {
  for (const std::string& node : video_nodes()) {
    const auto file = open_device(node, O_RDWR | O_NONBLOCK);
    v4l2_capability capability{};
    if (file && control(*file, VIDIOC_QUERYCAP, &capability) == 0 &&
        std::strcmp(reinterpret_cast<const char*>(capability.driver), "v4l2 loopback") == 0)
      return node;
  }
  return std::nullopt;
}

Result<LoopbackFeeder> LoopbackFeeder::open(const std::string& node, int samples_per_line,
                                            int lines_per_frame) {
  HAL_TRY(auto file, open_device(node, O_RDWR));
  v4l2_format format{};
  format.type = V4L2_BUF_TYPE_VIDEO_OUTPUT;
  v4l2_pix_format& pixels = format.fmt.pix;
  pixels.width = static_cast<__u32>(samples_per_line);
  pixels.height = static_cast<__u32>(lines_per_frame);
  pixels.pixelformat = V4L2_PIX_FMT_Y16;
  pixels.field = V4L2_FIELD_NONE;
  const __u32 line_bytes = 2 * pixels.width;
  const std::size_t frame_bytes = std::size_t{line_bytes} * pixels.height;
  if (control(file, VIDIOC_S_FMT, &format) == -1)
    return system_failure(node, "setting the feeder's format", errno);
  if (pixels.pixelformat != V4L2_PIX_FMT_Y16 || pixels.bytesperline != line_bytes ||
      pixels.height != static_cast<__u32>(lines_per_frame))
    return fail(
        ErrorCode::busy,
        fmt::format("{}: it keeps {}×{} pixels, expected {}×{} in Y16: somebody has it open", node,
                    pixels.width, pixels.height, samples_per_line, lines_per_frame));
  int type = V4L2_BUF_TYPE_VIDEO_OUTPUT;
  if (control(file, VIDIOC_STREAMON, &type) == -1)
    return system_failure(node, "starting the feeder's stream", errno);
  return LoopbackFeeder{std::move(file), node, frame_bytes};
}

Result<> LoopbackFeeder::write(std::span<const std::byte> frame) {
  ssize_t written = -1;
  do {
    written = ::write(file_.get(), frame.data(), frame.size());
  } while (written == -1 && errno == EINTR);
  if (written == -1)
    return system_failure(node_, "writing a frame", errno);
  if (static_cast<std::size_t>(written) != frame.size())
    return fail(ErrorCode::bad_data, fmt::format("{}: {} bytes of a frame were taken, expected {}",
                                                 node_, written, frame.size()));
  return {};
}

} // namespace octascope::tests
