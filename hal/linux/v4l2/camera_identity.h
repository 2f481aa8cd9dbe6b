// Which camera of its kind it is: what a calibration is compared with.
//
// A V4L2 driver tells a camera's make and its socket, and neither differs between two machines of
// one kind. What differs is the serial number that USB cameras have; the kernel shows it in sysfs.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "hal/linux/system/file_descriptor.h"

namespace octascope::hal::linux_backend {

// "/sys/dev/char/81:0/device" of an open device node; what it points to need not be there.
std::filesystem::path sysfs_folder(const FileDescriptor& node);

// That of the USB device to which the folder belongs; empty where it belongs to none, or has none.
std::string usb_serial_number(const std::filesystem::path& folder);

// "MAKE MODEL, serial 0123", or "MAKE MODEL, no serial number". Without the socket: it is the same
// camera in another one. What would end a text in TOML is replaced. Pure.
std::string camera_identity(std::string_view card, std::string_view serial_number);

} // namespace octascope::hal::linux_backend
