#include "hal/linux/v4l2/capture_node.h"

#include <cstring>
#include <optional>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <linux/videodev2.h>

#include "hal/linux/system/system_error.h"
#include "hal/linux/v4l2/camera_identity.h"
#include "hal/linux/v4l2/pixel_formats.h"

namespace octascope::hal::linux_backend {

namespace {

// More than any driver has: a driver that never ends its list must not hold us.
constexpr std::uint32_t most_formats = 256;
constexpr std::uint32_t most_sizes = 256;

template <std::size_t size> std::string text(const __u8 (&field)[size]) {
  const auto* begin = reinterpret_cast<const char*>(field);
  return {begin, ::strnlen(begin, size)};
}

v4l2_format as_kernel_format(const FormatRequest& request) {
  v4l2_format format{};
  format.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  format.fmt.pix.width = request.width;
  format.fmt.pix.height = request.height;
  format.fmt.pix.pixelformat = request.code;
  format.fmt.pix.field = V4L2_FIELD_NONE;
  format.fmt.pix.bytesperline = request.bytes_per_line;
  return format;
}

GivenFormat given(const v4l2_format& format) {
  const v4l2_pix_format& pixels = format.fmt.pix;
  return {.code = pixels.pixelformat,
          .width = pixels.width,
          .height = pixels.height,
          .bytes_per_line = pixels.bytesperline,
          .image_bytes = pixels.sizeimage,
          .field = pixels.field};
}

std::string_view what_it_is(std::uint32_t capabilities) {
  if ((capabilities & (V4L2_CAP_VIDEO_M2M | V4L2_CAP_VIDEO_M2M_MPLANE)) != 0)
    return "a converter from memory to memory";
  if ((capabilities & V4L2_CAP_VIDEO_CAPTURE_MPLANE) != 0)
    return "a camera with pictures in several planes";
  if ((capabilities & V4L2_CAP_META_CAPTURE) != 0)
    return "metadata";
  if ((capabilities & (V4L2_CAP_VIDEO_OUTPUT | V4L2_CAP_VIDEO_OUTPUT_MPLANE)) != 0)
    return "an output, or a loopback into which nobody writes";
  if ((capabilities & V4L2_CAP_VIDEO_CAPTURE) != 0)
    return "a camera that cannot stream";
  return "no camera";
}

} // namespace

Result<CaptureNode> CaptureNode::open(const std::string& node) {
  HAL_TRY(auto file, open_device(node, O_RDWR | O_NONBLOCK));
  v4l2_capability capability{};
  if (control(file, VIDIOC_QUERYCAP, &capability) == -1) {
    if (errno == ENOTTY)
      return fail(
          ErrorCode::unsupported,
          "{}: it is no video device; expected a V4L2 camera, `octascope devices` lists them",
          node);
    return system_failure(node, "asking what it can do", errno);
  }
  const std::uint32_t capabilities = (capability.capabilities & V4L2_CAP_DEVICE_CAPS) != 0
                                         ? capability.device_caps
                                         : capability.capabilities;
  NodeIdentity identity{node, text(capability.card), text(capability.driver),
                        text(capability.bus_info)};
  identity.camera = camera_identity(identity.card, usb_serial_number(sysfs_folder(file)));
  constexpr std::uint32_t needed = V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_STREAMING;
  if ((capabilities & needed) != needed ||
      (capabilities & (V4L2_CAP_VIDEO_M2M | V4L2_CAP_VIDEO_M2M_MPLANE)) != 0)
    return fail(ErrorCode::unsupported,
                "{}: \"{}\" is {}; expected a camera that streams mapped buffers", node,
                identity.card, what_it_is(capabilities));
  return CaptureNode{std::move(file), std::move(identity)};
}

Error CaptureNode::named(Error error) const {
  return {error.code,
          fmt::format("{} (\"{}\"): {}", identity_.node, identity_.card, std::move(error.message))};
}

Result<std::vector<OfferedFormat>> CaptureNode::formats() const {
  std::vector<OfferedFormat> offered;
  for (std::uint32_t index = 0; index < most_formats; ++index) {
    v4l2_fmtdesc description{};
    description.index = index;
    description.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    if (control(file_, VIDIOC_ENUM_FMT, &description) == -1) {
      if (errno == EINVAL)
        break;
      return system_failure(identity_.node, "listing its formats", errno);
    }
    // Sizes of formats that are not read anyway are of no interest.
    const bool readable = line_pixel_format(description.pixelformat) != nullptr;
    offered.push_back({description.pixelformat,
                       readable ? sizes(description.pixelformat) : std::vector<OfferedSize>{}});
  }
  return offered;
}

std::vector<OfferedSize> CaptureNode::sizes(std::uint32_t code) const {
  std::vector<OfferedSize> offered;
  for (std::uint32_t index = 0; index < most_sizes; ++index) {
    v4l2_frmsizeenum size{};
    size.index = index;
    size.pixel_format = code;
    if (control(file_, VIDIOC_ENUM_FRAMESIZES, &size) == -1)
      break; // no more; or the driver tells no sizes, then asking for one shows
    if (size.type == V4L2_FRMSIZE_TYPE_DISCRETE) {
      const v4l2_frmsize_discrete& one = size.discrete;
      offered.push_back({{one.width, one.width, 1}, {one.height, one.height, 1}});
      continue;
    }
    const v4l2_frmsize_stepwise& span = size.stepwise;
    offered.push_back({{span.min_width, span.max_width, span.step_width},
                       {span.min_height, span.max_height, span.step_height}});
    break;
  }
  return offered;
}

Result<FormatRequest> CaptureNode::choose_format(const LineFormat& wanted) const {
  HAL_TRY(const auto offered, formats());
  const auto requests = rank_formats(offered, wanted);
  if (!requests)
    return tl::make_unexpected(named(requests.error()));
  std::optional<Error> refusal;
  for (const FormatRequest& request : *requests) {
    v4l2_format format = as_kernel_format(request);
    if (control(file_, VIDIOC_TRY_FMT, &format) == -1) {
      if (errno == ENOTTY)
        return request; // a driver that cannot be asked: setting it will show
      if (!refusal)
        refusal = system_failure(identity_.node, "asking for " + fourcc_text(request.code), errno)
                      .value();
      continue;
    }
    const auto checked = check_given(request, given(format));
    if (checked)
      return request;
    if (!refusal)
      refusal = named(checked.error());
  }
  return tl::make_unexpected(*refusal);
}

Result<GivenFormat> CaptureNode::set_format(const FormatRequest& request) const {
  v4l2_format format = as_kernel_format(request);
  if (control(file_, VIDIOC_S_FMT, &format) == -1)
    return system_failure(identity_.node,
                          fmt::format("setting {} at {}×{}", fourcc_text(request.code),
                                      request.width, request.height),
                          errno);
  const GivenFormat answer = given(format);
  if (const auto checked = check_given(request, answer); !checked)
    return tl::make_unexpected(named(checked.error()));
  return answer;
}

Result<> CaptureNode::select_input(int input) const {
  int index = input;
  if (control(file_, VIDIOC_S_INPUT, &index) == -1)
    return system_failure(identity_.node, fmt::format("selecting input {}", input), errno);
  return {};
}

Result<> CaptureNode::set_window(const SensorWindow& window) const {
  v4l2_selection selection{};
  selection.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
  selection.target = V4L2_SEL_TGT_CROP;
  selection.r = {window.left, window.top, static_cast<__u32>(window.width),
                 static_cast<__u32>(window.height)};
  if (control(file_, VIDIOC_S_SELECTION, &selection) == -1)
    return system_failure(identity_.node, "setting the sensor's window", errno,
                          "leave the window out of the configuration, or ask the camera for "
                          "what it can do: `v4l2-ctl --get-selection target=crop_bounds`");
  const v4l2_rect& got = selection.r;
  const SensorWindow made{got.left, got.top, static_cast<int>(got.width),
                          static_cast<int>(got.height)};
  if (made != window)
    return fail(ErrorCode::unsupported,
                "{}: the sensor's window became {}×{} at {},{}; expected {}×{} at {},{}: configure "
                "one that the sensor can do",
                identity_.node, made.width, made.height, made.left, made.top, window.width,
                window.height, window.left, window.top);
  return {};
}

} // namespace octascope::hal::linux_backend
