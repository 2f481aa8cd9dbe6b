#include "hal/linux/kms/mode/mode_choice.h"

#include <algorithm>
#include <cmath>

#include <drm_mode.h>
#include <fmt/format.h>

#include "hal/number_text.h"

namespace octascope::hal::linux_backend::kms {

namespace {

constexpr int smallest = 100;
constexpr int largest = 16384;

tl::unexpected<Error> not_a_mode(std::string_view text) {
  return fail(
      ErrorCode::invalid_argument,
      "kms display: mode is \"{}\", expected \"preferred\", \"1920x1080\", \"1920x1080@60\" or, "
      "with computed timings, \"1920x1080M@60\" ({} to {} pixels either way, 1 to 1000 Hz)",
      text, smallest, largest);
}

bool take(std::string_view& text, char expected) {
  if (text.empty() || text.front() != expected)
    return false;
  text.remove_prefix(1);
  return true;
}

tl::unexpected<Error> no_such_mode(std::span<const Mode> modes, const ModeRequest& wanted) {
  std::string list;
  for (const Mode& mode : modes)
    list += (list.empty() ? "" : ", ") + to_text(mode);
  return fail(ErrorCode::unsupported,
              "kms display: no mode {}x{}{}, expected one of the monitor's: {}; set the mode to "
              "one of them, or to \"{}x{}M\" to try computed timings",
              wanted.width, wanted.height,
              wanted.refresh_hz ? fmt::format("@{}", *wanted.refresh_hz) : "",
              list.empty() ? "none" : list, wanted.width, wanted.height);
}

// Lines of vertical sync, by which monitors tell the aspect ratio (CVT 1.1, table 3-2).
int sync_lines(int width, int height) {
  const auto is = [&](int across, int down) { return height * across / down == width; };
  if (is(4, 3))
    return 4;
  if (is(16, 9))
    return 5;
  if (is(16, 10))
    return 6;
  if (is(5, 4) || is(15, 9))
    return 7;
  return 10;
}

} // namespace

Result<ModeRequest> parse_mode_request(std::string_view text) {
  ModeRequest wanted;
  if (text.empty() || text == "preferred")
    return wanted;
  std::string_view rest = text;
  const auto width = take_number<int>(rest);
  if (!width || !take(rest, 'x'))
    return not_a_mode(text);
  const auto height = take_number<int>(rest);
  if (!height || *width < smallest || *height < smallest || *width > largest || *height > largest)
    return not_a_mode(text);
  wanted.width = *width;
  wanted.height = *height;
  wanted.computed = take(rest, 'M');
  if (take(rest, '@')) {
    wanted.refresh_hz = take_number<double>(rest);
    if (!wanted.refresh_hz || !(*wanted.refresh_hz >= 1 && *wanted.refresh_hz <= 1000))
      return not_a_mode(text);
  }
  if (!rest.empty())
    return not_a_mode(text);
  return wanted;
}

Result<Mode> choose_mode(std::span<const Mode> modes, const ModeRequest& wanted) {
  if (wanted.computed)
    return computed_mode(wanted.width, wanted.height, wanted.refresh_hz.value_or(60));
  const Mode* best = nullptr;
  // The monitor's order decides between equals.
  const auto better = [&](const Mode& mode) {
    if (best == nullptr)
      return true;
    if (wanted.refresh_hz)
      return std::abs(refresh_hz(mode) - *wanted.refresh_hz) <
             std::abs(refresh_hz(*best) - *wanted.refresh_hz);
    return is_preferred(mode) && !is_preferred(*best);
  };
  for (const Mode& mode : modes) {
    const bool fits =
        wanted.width == 0 || (mode.width == wanted.width && mode.height == wanted.height);
    if (fits && !is_interlaced(mode) && refresh_hz(mode) > 0 && better(mode))
      best = &mode;
  }
  // Half a hertz: 60 and 59.94 are one wanted to a person, 50 is another.
  if (best == nullptr ||
      (wanted.refresh_hz && std::abs(refresh_hz(*best) - *wanted.refresh_hz) > 0.5))
    return no_such_mode(modes, wanted);
  return *best;
}

// Numbers as in CVT 1.1, section 5.3; times in µs.
Mode computed_mode(int asked_width, int height, double rate_hz) {
  constexpr double min_sync_and_back_porch = 550;
  constexpr int front_porch_lines = 3;
  constexpr double clock_step_khz = 250;
  const int width = asked_width - asked_width % 8;

  const double line_estimate = (1e6 / rate_hz - min_sync_and_back_porch) / (height + 3);
  const int sync = sync_lines(width, height);
  const int sync_and_back_porch =
      std::max(static_cast<int>(min_sync_and_back_porch / line_estimate) + 1, sync + 3);
  const int vtotal = height + sync_and_back_porch + front_porch_lines;

  const double blank_percent = std::max(30 - 0.3 * line_estimate, 20.0);
  const double ideal_blank = width * blank_percent / (100 - blank_percent);
  const int blank = static_cast<int>(ideal_blank) / 16 * 16;
  const int htotal = width + blank;
  const int hsync_end = width + blank / 2;
  const int hsync_earliest = hsync_end - htotal * 8 / 100;
  const int hsync_start = hsync_earliest + 8 - hsync_earliest % 8;

  const auto lines = [](int value) { return static_cast<std::uint16_t>(value); };
  Mode mode;
  mode.name = fmt::format("{}x{}", width, height);
  mode.clock_khz = static_cast<std::uint32_t>(
      std::floor(htotal * 1e3 / line_estimate / clock_step_khz) * clock_step_khz);
  mode.width = lines(width);
  mode.hsync_start = lines(hsync_start);
  mode.hsync_end = lines(hsync_end);
  mode.htotal = lines(htotal);
  mode.height = lines(height);
  mode.vsync_start = lines(height + front_porch_lines);
  mode.vsync_end = lines(height + front_porch_lines + sync);
  mode.vtotal = lines(vtotal);
  mode.flags = DRM_MODE_FLAG_NHSYNC | DRM_MODE_FLAG_PVSYNC;
  mode.type = DRM_MODE_TYPE_USERDEF;
  return mode;
}

} // namespace octascope::hal::linux_backend::kms
