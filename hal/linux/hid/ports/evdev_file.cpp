#include "hal/linux/hid/ports/evdev_file.h"

#include <cerrno>
#include <utility>

#include <fcntl.h>
#include <libevdev/libevdev.h>

#include "hal/linux/system/system_error.h"

namespace octascope::hal::linux_backend {

void EvdevFile::Freer::operator()(libevdev* device) const {
  libevdev_free(device); // ungrabs
}

EvdevFile::EvdevFile(FileDescriptor file, std::unique_ptr<libevdev, Freer> device, std::string node)
    : file_{std::move(file)}, device_{std::move(device)}, node_{std::move(node)} {}

Result<EvdevFile> EvdevFile::open(const std::string& node) {
  HAL_TRY(auto file, open_device(node, O_RDWR | O_NONBLOCK));
  libevdev* made = nullptr;
  if (const int status = libevdev_new_from_fd(file.get(), &made); status < 0)
    return system_failure(node, "asking what it is", -status);
  std::unique_ptr<libevdev, Freer> device{made};
  if (const int status = libevdev_grab(device.get(), LIBEVDEV_GRAB); status < 0)
    return system_failure(node, "taking it for octascope alone", -status);
  return EvdevFile{std::move(file), std::move(device), node};
}

bool EvdevFile::has_key(std::uint16_t code) const {
  return libevdev_has_event_code(device_.get(), EV_KEY, code) != 0;
}

Result<std::optional<KeyEvent>> EvdevFile::next() {
  input_event event{};
  int status = libevdev_next_event(
      device_.get(), catching_up_ ? LIBEVDEV_READ_FLAG_SYNC : LIBEVDEV_READ_FLAG_NORMAL, &event);
  if (status == -EAGAIN && catching_up_) {
    catching_up_ = false;
    status = libevdev_next_event(device_.get(), LIBEVDEV_READ_FLAG_NORMAL, &event);
  }
  if (status == -EAGAIN || status == -EINTR)
    return std::nullopt;
  if (status < 0)
    return system_failure(node_, "reading", -status);
  catching_up_ = status == LIBEVDEV_READ_STATUS_SYNC;
  return KeyEvent{event.type, event.code, event.value};
}

} // namespace octascope::hal::linux_backend
