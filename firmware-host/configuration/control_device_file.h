// A control that octascope was taught: which of its bits, or which keys, are its switches. Written
// by `devices --learn`, named in the configuration as [controls] device.
//
//   usb = "1234:5678"
//   name = "Somebody's pedal"
//   report_id = 1             # where it numbers its reports
//   [[switch]]                # in their order; each a bit of a report (byte 0 is the ID, if any) …
//   byte = 1
//   mask = 4
//   [[switch]]                # … or each a key (linux/input-event-codes.h)
//   key = 30
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hal/linux/hid/models/control_model.h"
#include "hal/result.h"

namespace octascope::firmware_host {

hal::Result<hal::linux_backend::ControlModel>
load_control_device(const std::filesystem::path& file);
hal::Result<hal::linux_backend::ControlModel>
parse_control_device(std::string_view text, const std::filesystem::path& name);

// The controls that may be opened: the learned one first, if its file can be read, then the listed
// ones.
std::vector<hal::linux_backend::ControlModel>
control_models(const std::optional<std::filesystem::path>& learned);

std::string control_device_text(const hal::linux_backend::ControlModel& model);

// An initial control profile (ui/controls/control_profile.h): the first switch freezes, the last
// steps through the functions, and a long press performs the selected one.
std::string first_profile_text(const hal::linux_backend::ControlModel& model);

} // namespace octascope::firmware_host
