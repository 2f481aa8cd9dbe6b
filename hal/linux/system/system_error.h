// Turns errno into an Error that says what to do.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "hal/linux/system/file_descriptor.h"
#include "hal/result.h"

namespace octascope::hal::linux_backend {

// ENODEV, EIO …: disconnected. ENOENT …: absent. EBUSY: busy. EACCES, EPERM …: denied. ETIMEDOUT:
// timed_out. EINVAL, ENOTTY …: unsupported. All others: system.
ErrorCode error_code_of(int error_number);

// "/dev/video0: opening failed: Permission denied; <remedy>". If `remedy` is empty, the usual one
// for the error is given (how to join the group, how to find the program that has the device).
tl::unexpected<Error> system_failure(std::string_view device, std::string_view action,
                                     int error_number, std::string_view remedy = {});

// Whether udev is still processing devices, at boot or after something was plugged in. Until it has
// processed a device, only root may open it. Looks in `root`/run.
bool udev_is_at_work(const std::filesystem::path& root = "/");

// Opens with O_CLOEXEC; the Error's message names the device and the remedy. If access is denied
// while udev is at work, returns ErrorCode::absent, because udev may be about to grant it.
Result<FileDescriptor> open_device(const std::string& node, int flags);

} // namespace octascope::hal::linux_backend
