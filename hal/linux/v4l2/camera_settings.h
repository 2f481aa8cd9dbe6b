// Exposure, gain and line rate, checked against what the camera's controls can take.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hal/linux/system/file_descriptor.h"
#include "hal/result.h"

namespace octascope::hal::linux_backend {

struct NamedSetting {
  std::string name; // as the driver calls it: `v4l2-ctl --list-ctrls` without underscores
  std::int64_t value = 0;
};

struct CameraSettings {
  std::optional<double> exposure_us = {};
  std::optional<int> gain = {}; // in the camera's own steps
  std::vector<NamedSetting> others = {};
};

// What a control takes. Pure.
struct SettingRange {
  std::string name;
  std::int64_t least = 0, most = 0, step = 1;
  bool settable = true; // to a number
};

// The value that the control takes for the wanted one: on its steps, the nearest. Pure.
// ErrorCode::invalid_argument with found and expected outside its range; ErrorCode::unsupported for
// one that cannot be set.
Result<std::int64_t> fit_setting(const SettingRange& range, std::int64_t wanted);

// How long a sensor pauses after each line for a line rate, in pixels (kernel documentation,
// "Image Source Control Reference": line rate = pixel rate / (width + horizontal blanking)). Pure.
// ErrorCode::unsupported with the rates that are possible.
Result<std::int64_t> blanking_for(double line_rate_hz, std::int64_t pixel_rate_hz, int width,
                                  const SettingRange& blanking);

// Sets all of them, exposure and gain after ending the camera's automatic of it; says in words what
// was set, and what the camera does not have. An Error for what was asked for explicitly and cannot
// be had. Line rate: where the camera has such a control.
Result<std::vector<std::string>> apply_settings(const FileDescriptor& file, std::string_view node,
                                                const CameraSettings& settings, double line_rate_hz,
                                                int width);

} // namespace octascope::hal::linux_backend
