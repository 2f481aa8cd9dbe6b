#include "hal/linux/hid/ports/hidraw_port.h"

#include <cerrno>

#include <fcntl.h>
#include <unistd.h>

#include "hal/linux/system/system_error.h"

namespace octascope::hal::linux_backend {

Result<std::unique_ptr<ControlPort>> HidrawPort::open(const HidNode& node,
                                                      const ControlModel& model) {
  HAL_TRY(auto file, open_device(node.node, O_RDWR | O_NONBLOCK));
  return std::make_unique<HidrawPort>(std::move(file), node.node, model);
}

HidrawPort::HidrawPort(FileDescriptor file, std::string node, const ControlModel& model)
    : file_{std::move(file)}, node_{std::move(node)}, family_{model.family}, decoder_{
                                                                                 make_hid_decoder(
                                                                                     model)} {}

Result<bool> HidrawPort::do_read(std::optional<HidReading>& reading) {
  reading.reset();
  const ssize_t size = ::read(file_.get(), report_.data(), report_.size());
  if (size > 0) {
    reading = decoder_->decode(std::span{report_}.first(static_cast<std::size_t>(size)));
    return true;
  }
  if (size < 0 && (errno == EAGAIN || errno == EINTR))
    return false;
  return system_failure(node_, "reading", size == 0 ? ENODEV : errno);
}

void HidrawPort::do_light(bool on) {
  if (family_ != HidFamily::space_mouse)
    return;
  const std::array<std::uint8_t, 2> lamp{4, on ? std::uint8_t{1} : std::uint8_t{0}};
  [[maybe_unused]] const ssize_t written = ::write(file_.get(), lamp.data(), lamp.size());
}

} // namespace octascope::hal::linux_backend
