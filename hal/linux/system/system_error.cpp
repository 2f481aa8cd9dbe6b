#include "hal/linux/system/system_error.h"

#include <cerrno>
#include <system_error>

#include <fcntl.h>
#include <fmt/format.h>

namespace octascope::hal::linux_backend {

namespace {

std::string usual_mend(std::string_view device, Fault fault) {
  switch (fault) {
  case Fault::denied:
    return fmt::format("see which group owns it with `ls -l {}`, join it with `sudo usermod -aG "
                       "<group> $USER` and log in again",
                       device);
  case Fault::busy:
    return fmt::format("another program has it: `sudo fuser -v {}` names it; end that program",
                       device);
  case Fault::absent:
  case Fault::disconnected: return "check the plug and the cable; it is tried again by itself";
  default: return {};
  }
}

} // namespace

bool udev_is_at_work(const std::filesystem::path& root) {
  std::error_code error;
  return std::filesystem::exists(root / "run/udev/queue", error);
}

Fault fault_of(int error_number) {
  switch (error_number) {
  case ENODEV:
  case ENXIO:
  case EIO:
  case EPIPE:
  case ESHUTDOWN: return Fault::disconnected;
  case ENOENT:
  case ENOTDIR: return Fault::absent;
  case EBUSY: return Fault::busy;
  case EACCES:
  case EPERM:
  case EROFS: return Fault::denied;
  case ETIMEDOUT: return Fault::timed_out;
  case EINVAL:
  case ENOTTY:
  case ENOSYS:
  case EOPNOTSUPP: return Fault::unsupported;
  default: return Fault::system;
  }
}

tl::unexpected<Error> system_failure(std::string_view device, std::string_view action,
                                     int error_number, std::string_view mend) {
  const Fault fault = fault_of(error_number);
  const std::string advice = mend.empty() ? usual_mend(device, fault) : std::string{mend};
  return fail(fault, fmt::format("{}: {} failed: {}{}{}", device, action,
                                 std::generic_category().message(error_number),
                                 advice.empty() ? "" : "; ", advice));
}

Result<FileDescriptor> open_device(const std::string& node, int flags) {
  int descriptor = -1;
  do {
    descriptor = ::open(node.c_str(), flags | O_CLOEXEC);
  } while (descriptor == -1 && errno == EINTR);
  if (descriptor == -1) {
    const int why = errno;
    if (why == EACCES && udev_is_at_work())
      return fail(Fault::absent, fmt::format("{}: udev has not gone through it yet; it is tried "
                                             "again by itself",
                                             node));
    // A node whose driver has gone says ENODEV or ENXIO: to whoever opens it, it is not there.
    return system_failure(node, "opening", why == ENODEV || why == ENXIO ? ENOENT : why);
  }
  return FileDescriptor{descriptor};
}

} // namespace octascope::hal::linux_backend
