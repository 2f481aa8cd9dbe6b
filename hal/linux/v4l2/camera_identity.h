// Identifies the individual camera, so that a calibration can be matched to it.
//
// A V4L2 driver reports a camera's make and socket, which may be the same on two machines. The
// serial number differs; USB cameras have one, and the kernel shows it in sysfs.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "hal/linux/system/file_descriptor.h"

namespace octascope::hal::linux_backend {

// "/sys/dev/char/81:0/device" for an open device node; the path need not exist.
std::filesystem::path sysfs_folder(const FileDescriptor& node);

// The serial number of the USB device to which `folder` belongs; empty if there is none.
std::string usb_serial_number(const std::filesystem::path& folder);

// "MAKE MODEL, serial 0123", or "MAKE MODEL, no serial number". The socket is left out, since the
// camera may be moved. Characters that would end a TOML string are replaced. Pure.
std::string camera_identity(std::string_view card, std::string_view serial_number);

} // namespace octascope::hal::linux_backend
