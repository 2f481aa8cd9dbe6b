// Exposure, gain and line rate, checked against the ranges of the camera's controls.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hal/line_camera.h"
#include "hal/linux/system/file_descriptor.h"
#include "hal/result.h"

namespace octascope::hal::linux_backend {

struct NamedSetting {
  std::string name; // the driver's: as in `v4l2-ctl --list-ctrls`, without underscores
  std::int64_t value = 0;
};

struct CameraSettings {
  std::optional<double> exposure_us = {};
  std::optional<int> gain = {}; // in the camera's own steps
  std::vector<NamedSetting> others = {};
};

// The values that a control accepts.
struct SettingRange {
  std::string name;
  std::int64_t least = 0, most = 0, step = 1;
  bool settable = true; // to a number
};

// The value on the control's steps that is nearest to `wanted`. Pure. ErrorCode::invalid_argument,
// with found and expected: outside the range. ErrorCode::unsupported: the control cannot be set.
Result<std::int64_t> fit_setting(const SettingRange& range, std::int64_t wanted);

// The horizontal blanking, in pixels, for a line rate (kernel documentation, "Image Source Control
// Reference": line rate = pixel rate / (width + horizontal blanking)). Pure.
// ErrorCode::unsupported: not possible; the message has the possible rates.
Result<std::int64_t> blanking_for(double line_rate_hz, std::int64_t pixel_rate_hz, int width,
                                  const SettingRange& blanking);

// Applies all settings; first turns off automatic exposure and gain if they are to be set. Sets the
// line rate only if the camera has such a control. Returns, as text, what was set and what the
// camera does not have; an Error if an explicit setting is not possible.
Result<std::vector<std::string>> apply_settings(const FileDescriptor& file, std::string_view node,
                                                const CameraSettings& settings, double line_rate_hz,
                                                int width);

// Exposure and gain as they are, where they can be set.
CameraControls read_controls(const FileDescriptor& file);

} // namespace octascope::hal::linux_backend
