#include "hal/linux/v4l2/camera_settings.h"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cmath>
#include <cstring>

#include <fmt/format.h>
#include <linux/videodev2.h>

#include "hal/linux/system/system_error.h"

namespace octascope::hal::linux_backend {

namespace {

constexpr int most_controls = 1024;      // a driver that never ends its list must not hold us
constexpr double exposure_unit_us = 100; // of V4L2_CID_EXPOSURE_ABSOLUTE

struct Setting {
  std::uint32_t id = 0;
  SettingRange range;
  bool governed = false; // by another control at the moment, an automatic mostly
};

Setting setting(const v4l2_query_ext_ctrl& query) {
  constexpr __u32 no_number =
      V4L2_CTRL_FLAG_READ_ONLY | V4L2_CTRL_FLAG_DISABLED | V4L2_CTRL_FLAG_HAS_PAYLOAD;
  return {query.id,
          {.name = {query.name, ::strnlen(query.name, sizeof query.name)},
           .least = query.minimum,
           .most = query.maximum,
           .step = static_cast<std::int64_t>(std::max<__u64>(query.step, 1)),
           .settable = (query.flags & no_number) == 0},
          (query.flags & V4L2_CTRL_FLAG_INACTIVE) != 0};
}

std::optional<Setting> find(const FileDescriptor& file, std::uint32_t id) {
  v4l2_query_ext_ctrl query{};
  query.id = id;
  if (control(file, VIDIOC_QUERY_EXT_CTRL, &query) == -1)
    return std::nullopt;
  return setting(query);
}

bool same_name(std::string_view a, std::string_view b) {
  return std::ranges::equal(
      a, b, [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); });
}

std::optional<Setting> find(const FileDescriptor& file, std::string_view name) {
  v4l2_query_ext_ctrl query{};
  for (int i = 0; i < most_controls; ++i) {
    query.id |= V4L2_CTRL_FLAG_NEXT_CTRL;
    if (control(file, VIDIOC_QUERY_EXT_CTRL, &query) == -1)
      return std::nullopt;
    if (Setting found = setting(query); same_name(found.range.name, name))
      return found;
  }
  return std::nullopt;
}

Result<> write(const FileDescriptor& file, std::string_view node, const Setting& setting,
               std::int64_t value) {
  v4l2_ext_control one{};
  one.id = setting.id;
  one.value64 = value;
  if (setting.range.least >= INT32_MIN && setting.range.most <= INT32_MAX)
    one.value = static_cast<__s32>(value);
  v4l2_ext_controls all{};
  all.which = V4L2_CTRL_WHICH_CUR_VAL;
  all.count = 1;
  all.controls = &one;
  if (control(file, VIDIOC_S_EXT_CTRLS, &all) == -1)
    return system_failure(node, fmt::format("setting \"{}\" to {}", setting.range.name, value),
                          errno);
  return {};
}

std::optional<std::int64_t> read(const FileDescriptor& file, std::uint32_t id) {
  v4l2_ext_control one{};
  one.id = id;
  v4l2_ext_controls all{};
  all.which = V4L2_CTRL_WHICH_CUR_VAL;
  all.count = 1;
  all.controls = &one;
  if (control(file, VIDIOC_G_EXT_CTRLS, &all) == -1)
    return std::nullopt;
  const std::int64_t value = one.value64; // a packed field cannot be referred to
  return value;
}

// A control of 32 bits fills half of the field.
std::optional<std::int64_t> read_number(const FileDescriptor& file, const Setting& setting) {
  const auto value = read(file, setting.id);
  if (value && setting.range.least >= INT32_MIN && setting.range.most <= INT32_MAX)
    return static_cast<std::int32_t>(*value);
  return value;
}

Result<std::string> set(const FileDescriptor& file, std::string_view node,
                        const std::optional<Setting>& found, std::string_view name,
                        std::int64_t wanted) {
  if (!found)
    return fail(ErrorCode::unsupported,
                "{}: it has no control \"{}\", which is configured to be {}; take it out of the "
                "configuration, `v4l2-ctl -d {} --list-ctrls` shows what it has",
                node, name, wanted, node);
  const auto value = fit_setting(found->range, wanted);
  if (!value)
    return fail(value.error().code, "{}: {}", node, value.error().message);
  HAL_CHECK(write(file, node, *found, *value));
  return fmt::format("{} set to {}{}", found->range.name, *value,
                     found->governed ? ", which has no effect while another control governs it"
                                     : "");
}

std::optional<Setting> find_gain(const FileDescriptor& file) {
  auto gain = find(file, V4L2_CID_ANALOGUE_GAIN);
  return gain ? gain : find(file, V4L2_CID_GAIN);
}

std::optional<CameraControl> read_control(const FileDescriptor& file,
                                          const std::optional<Setting>& found, double unit) {
  if (!found || !found->range.settable)
    return std::nullopt;
  const auto value = read_number(file, *found);
  if (!value)
    return std::nullopt;
  return CameraControl{.value = static_cast<double>(*value) * unit,
                       .least = static_cast<double>(found->range.least) * unit,
                       .most = static_cast<double>(found->range.most) * unit};
}

// A value that is set by hand would have no effect while the camera's automatic is on. Not every
// camera has one.
void end_automatic(const FileDescriptor& file, std::string_view node, std::uint32_t id,
                   std::int64_t by_hand) {
  if (const auto automatic = find(file, id))
    (void)write(file, node, *automatic, by_hand);
}

Result<std::string> set_line_rate(const FileDescriptor& file, std::string_view node,
                                  double line_rate_hz, int width) {
  const auto blanking = find(file, V4L2_CID_HBLANK);
  const auto pixel_rate = read(file, V4L2_CID_PIXEL_RATE);
  if (!blanking || !blanking->range.settable || !pixel_rate)
    return fmt::format("it has no control of the line rate, which is taken to be {} Hz as "
                       "configured",
                       line_rate_hz);
  const auto pixels = blanking_for(line_rate_hz, *pixel_rate, width, blanking->range);
  if (!pixels)
    return fail(pixels.error().code, "{}: {}", node, pixels.error().message);
  HAL_CHECK(write(file, node, *blanking, *pixels));
  return fmt::format("line rate set to {:.1f} Hz",
                     static_cast<double>(*pixel_rate) / static_cast<double>(width + *pixels));
}

} // namespace

CameraControls read_controls(const FileDescriptor& file) {
  return {.exposure_us =
              read_control(file, find(file, V4L2_CID_EXPOSURE_ABSOLUTE), exposure_unit_us),
          .gain = read_control(file, find_gain(file), 1)};
}

Result<std::int64_t> fit_setting(const SettingRange& range, std::int64_t wanted) {
  if (!range.settable)
    return fail(ErrorCode::unsupported,
                "control \"{}\" cannot be set to a number, it is configured to be {}; take it out "
                "of the configuration",
                range.name, wanted);
  if (wanted < range.least || wanted > range.most)
    return fail(ErrorCode::invalid_argument,
                "control \"{}\" is configured to be {}, expected {} to {}", range.name, wanted,
                range.least, range.most);
  // In unsigned numbers: the distance of two 64-bit numbers need not fit a signed one.
  const auto step = static_cast<std::uint64_t>(std::max<std::int64_t>(range.step, 1));
  const std::uint64_t above =
      static_cast<std::uint64_t>(wanted) - static_cast<std::uint64_t>(range.least);
  const std::uint64_t room =
      static_cast<std::uint64_t>(range.most) - static_cast<std::uint64_t>(range.least);
  std::uint64_t snapped = above / step * step;
  if (above - snapped > step / 2 && room - snapped >= step)
    snapped += step;
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(range.least) + snapped);
}

Result<std::int64_t> blanking_for(double line_rate_hz, std::int64_t pixel_rate_hz, int width,
                                  const SettingRange& blanking) {
  const double rate = static_cast<double>(pixel_rate_hz);
  const double pixels = std::round(rate / line_rate_hz - width);
  const auto least = static_cast<double>(blanking.least);
  const auto most = static_cast<double>(blanking.most);
  if (!(rate > 0 && width + least > 0 && most >= least))
    return fail(ErrorCode::unsupported,
                "the sensor's pixel rate is {} Hz, its blanking {} to {}; expected figures that "
                "make a line rate",
                pixel_rate_hz, blanking.least, blanking.most);
  if (!(pixels >= least && pixels <= most))
    return fail(ErrorCode::unsupported,
                "the line rate is configured to be {} Hz, expected {:.1f} to {:.1f} Hz with lines "
                "of {} pixels on this sensor",
                line_rate_hz, rate / (width + most), rate / (width + least), width);
  return fit_setting(blanking, static_cast<std::int64_t>(pixels));
}

Result<std::vector<std::string>> apply_settings(const FileDescriptor& file, std::string_view node,
                                                const CameraSettings& settings, double line_rate_hz,
                                                int width) {
  if (settings.exposure_us && !(*settings.exposure_us > 0))
    return fail(ErrorCode::invalid_argument,
                "{}: the exposure is configured to be {} µs, expected more than 0", node,
                *settings.exposure_us);
  std::vector<Result<std::string>> done;
  for (const NamedSetting& other : settings.others)
    done.push_back(set(file, node, find(file, other.name), other.name, other.value));
  if (settings.exposure_us) {
    end_automatic(file, node, V4L2_CID_EXPOSURE_AUTO, V4L2_EXPOSURE_MANUAL);
    done.push_back(set(file, node, find(file, V4L2_CID_EXPOSURE_ABSOLUTE), "Exposure Time",
                       std::llround(std::min(*settings.exposure_us / exposure_unit_us, 1e9))));
  }
  if (settings.gain) {
    end_automatic(file, node, V4L2_CID_AUTOGAIN, 0);
    done.push_back(set(file, node, find_gain(file), "Gain", *settings.gain));
  }
  done.push_back(set_line_rate(file, node, line_rate_hz, width));
  std::vector<std::string> words;
  for (const Result<std::string>& one : done) {
    if (!one)
      return tl::make_unexpected(one.error());
    words.push_back(*one);
  }
  return words;
}

} // namespace octascope::hal::linux_backend
