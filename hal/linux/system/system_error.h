// From errno to an Error that says what to do.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "hal/linux/system/file_descriptor.h"
#include "hal/result.h"

namespace octascope::hal::linux_backend {

// ENODEV and its like: the device was there and is gone. ENOENT: it is not there. EBUSY: somebody
// has it. EACCES, EPERM: not allowed. ETIMEDOUT: no answer. EINVAL, ENOTTY …: cannot do it.
ErrorCode error_code_of(int error_number);

// "/dev/video0: opening failed: Permission denied; <remedy>". If `remedy` is empty, the usual one
// for such a fault is given (which group, who holds it).
tl::unexpected<Error> system_failure(std::string_view device, std::string_view action,
                                     int error_number, std::string_view remedy = {});

// While the machine starts, or something was plugged in: until udev has gone through a device it
// belongs to root alone. Looks at `root`/run.
bool udev_is_at_work(const std::filesystem::path& root = "/");

// Opens with O_CLOEXEC; the Error's message has the device and what fixes it. ErrorCode::absent,
// not denied, where udev may be about to allow it.
Result<FileDescriptor> open_device(const std::string& node, int flags);

} // namespace octascope::hal::linux_backend
