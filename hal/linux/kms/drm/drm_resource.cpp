#include "hal/linux/kms/drm/drm_resource.h"

#include <algorithm>
#include <cmath>

namespace octascope::hal::linux_backend::kms {

Mode from_kernel(const drmModeModeInfo& mode) {
  const auto* const end = std::find(std::begin(mode.name), std::end(mode.name), '\0');
  Mode result;
  result.name.assign(std::begin(mode.name), end);
  result.clock_khz = mode.clock;
  result.width = mode.hdisplay;
  result.hsync_start = mode.hsync_start;
  result.hsync_end = mode.hsync_end;
  result.htotal = mode.htotal;
  result.hskew = mode.hskew;
  result.height = mode.vdisplay;
  result.vsync_start = mode.vsync_start;
  result.vsync_end = mode.vsync_end;
  result.vtotal = mode.vtotal;
  result.vscan = mode.vscan;
  result.flags = mode.flags;
  result.type = mode.type;
  return result;
}

drmModeModeInfo to_kernel(const Mode& mode) {
  drmModeModeInfo result{};
  mode.name.copy(result.name, sizeof result.name - 1);
  result.clock = mode.clock_khz;
  result.hdisplay = mode.width;
  result.hsync_start = mode.hsync_start;
  result.hsync_end = mode.hsync_end;
  result.htotal = mode.htotal;
  result.hskew = mode.hskew;
  result.vdisplay = mode.height;
  result.vsync_start = mode.vsync_start;
  result.vsync_end = mode.vsync_end;
  result.vtotal = mode.vtotal;
  result.vscan = mode.vscan;
  result.vrefresh = static_cast<std::uint32_t>(std::lround(refresh_hz(mode)));
  result.flags = mode.flags;
  result.type = mode.type;
  return result;
}

} // namespace octascope::hal::linux_backend::kms
