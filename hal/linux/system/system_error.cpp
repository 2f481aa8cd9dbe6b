#include "hal/linux/system/system_error.h"

#include <cerrno>
#include <system_error>

#include <fcntl.h>
#include <fmt/format.h>

namespace octascope::hal::linux_backend {

namespace {

std::string usual_remedy(std::string_view device, ErrorCode fault) {
  switch (fault) {
  case ErrorCode::denied:
    return fmt::format("see which group owns it with `ls -l {}`, join it with `sudo usermod -aG "
                       "<group> $USER` and log in again",
                       device);
  case ErrorCode::busy:
    return fmt::format("another program has it: `sudo fuser -v {}` names it; end that program",
                       device);
  case ErrorCode::absent:
  case ErrorCode::disconnected: return "check the plug and the cable; it is tried again by itself";
  default: return {};
  }
}

} // namespace

bool udev_is_at_work(const std::filesystem::path& root) {
  std::error_code error;
  return std::filesystem::exists(root / "run/udev/queue", error);
}

ErrorCode error_code_of(int error_number) {
  switch (error_number) {
  case ENODEV:
  case ENXIO:
  case EIO:
  case EPIPE:
  case ESHUTDOWN: return ErrorCode::disconnected;
  case ENOENT:
  case ENOTDIR: return ErrorCode::absent;
  case EBUSY: return ErrorCode::busy;
  case EACCES:
  case EPERM:
  case EROFS: return ErrorCode::denied;
  case ETIMEDOUT: return ErrorCode::timed_out;
  case EINVAL:
  case ENOTTY:
  case ENOSYS:
  case EOPNOTSUPP: return ErrorCode::unsupported;
  default: return ErrorCode::system;
  }
}

tl::unexpected<Error> system_failure(std::string_view device, std::string_view action,
                                     int error_number, std::string_view remedy) {
  const ErrorCode fault = error_code_of(error_number);
  const std::string advice = remedy.empty() ? usual_remedy(device, fault) : std::string{remedy};
  return fail(fault, "{}: {} failed: {}{}{}", device, action,
              std::generic_category().message(error_number), advice.empty() ? "" : "; ", advice);
}

Result<FileDescriptor> open_device(const std::string& node, int flags) {
  int descriptor = -1;
  do {
    descriptor = ::open(node.c_str(), flags | O_CLOEXEC);
  } while (descriptor == -1 && errno == EINTR);
  if (descriptor == -1) {
    const int why = errno;
    if (why == EACCES && udev_is_at_work())
      return fail(ErrorCode::absent,
                  "{}: udev has not gone through it yet; it is tried again by itself", node);
    // A node whose driver has gone says ENODEV or ENXIO: to whoever opens it, it is not there.
    return system_failure(node, "opening", why == ENODEV || why == ENXIO ? ENOENT : why);
  }
  return FileDescriptor{descriptor};
}

} // namespace octascope::hal::linux_backend
