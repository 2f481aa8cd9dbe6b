#include "hal/linux/hid/evdev_port.h"

#include <cerrno>

#include <fcntl.h>
#include <libevdev/libevdev.h>
#include <unistd.h>

#include "hal/linux/hid/key_decoder.h"
#include "hal/linux/system/file_descriptor.h"
#include "hal/linux/system/system_error.h"

namespace octascope::hal::linux_backend {

namespace {

struct Freer {
  void operator()(libevdev* device) const { libevdev_free(device); } // ungrabs
};
using Device = std::unique_ptr<libevdev, Freer>;

class EvdevPort final : public ControlPort {
public:
  EvdevPort(FileDescriptor file, Device device, std::string node, const ControlModel& model)
      : file_{std::move(file)}, device_{std::move(device)}, node_{std::move(node)},
        family_{model.family}, decoder_{model} {}

private:
  int do_descriptor() const override { return file_.get(); }

  Result<bool> do_read(std::optional<HidReading>& reading) override {
    reading.reset();
    input_event event{};
    // After an overflow of the kernel's buffer libevdev tells what has changed meanwhile.
    int status = libevdev_next_event(
        device_.get(), catching_up_ ? LIBEVDEV_READ_FLAG_SYNC : LIBEVDEV_READ_FLAG_NORMAL, &event);
    if (status == -EAGAIN && catching_up_) {
      catching_up_ = false;
      status = libevdev_next_event(device_.get(), LIBEVDEV_READ_FLAG_NORMAL, &event);
    }
    if (status == -EAGAIN || status == -EINTR)
      return false;
    if (status < 0)
      return system_failure(node_, "reading", -status);
    catching_up_ = status == LIBEVDEV_READ_STATUS_SYNC;
    reading = decoder_.decode({event.type, event.code, event.value});
    return true;
  }

  void do_light(bool on) override {
    if (family_ != HidFamily::powermate)
      return;
    input_event lamp{};
    lamp.type = EV_MSC;
    lamp.code = MSC_PULSELED;
    lamp.value = on ? 0xff : 0; // bits 0–7: brightness; the rest would let it pulse
    [[maybe_unused]] const ssize_t written = ::write(file_.get(), &lamp, sizeof lamp);
  }

  FileDescriptor file_; // outlives the device
  Device device_;
  std::string node_;
  HidFamily family_;
  KeyDecoder decoder_;
  bool catching_up_ = false;
};

} // namespace

Result<std::unique_ptr<ControlPort>> open_evdev_port(const HidNode& node,
                                                     const ControlModel& model) {
  auto file = open_device(node.node, O_RDWR | O_NONBLOCK);
  if (!file)
    return tl::make_unexpected(file.error());
  libevdev* made = nullptr;
  if (const int status = libevdev_new_from_fd(file->get(), &made); status < 0)
    return system_failure(node.node, "asking what it is", -status);
  Device device{made};
  if (const int status = libevdev_grab(device.get(), LIBEVDEV_GRAB); status < 0)
    return system_failure(node.node, "taking it for octascope alone", -status);
  return std::make_unique<EvdevPort>(std::move(*file), std::move(device), node.node, model);
}

} // namespace octascope::hal::linux_backend
