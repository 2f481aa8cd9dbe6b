// A hidraw node. Read directly and not through hidapi: hidapi 0.13 has no descriptor to wait on
// together with other devices and with udev, and its hidraw backend is the same read().
#pragma once

#include <array>

#include "hal/linux/hid/ports/control_port.h"
#include "hal/linux/system/file_descriptor.h"

namespace octascope::hal::linux_backend {

class HidrawPort final : public ControlPort {
public:
  static Result<std::unique_ptr<ControlPort>> open(const HidNode& node, const ControlModel& model);
  HidrawPort(FileDescriptor file, std::string node, const ControlModel& model);

private:
  int do_descriptor() const override { return file_.get(); }
  Result<bool> do_read(std::optional<HidReading>& reading) override;
  void do_light(bool on) override;

  FileDescriptor file_;
  std::string node_;
  HidFamily family_;
  std::unique_ptr<HidDecoder> decoder_;
  std::array<std::uint8_t, 256> report_{};
};

} // namespace octascope::hal::linux_backend
