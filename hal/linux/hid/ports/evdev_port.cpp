#include "hal/linux/hid/ports/evdev_port.h"

#include <utility>

#include <linux/input.h>
#include <unistd.h>

#include "hal/linux/hid/decoders/key_decoder.h"
#include "hal/linux/hid/ports/evdev_file.h"

namespace octascope::hal::linux_backend {

namespace {

class EvdevPort final : public ControlPort {
public:
  EvdevPort(EvdevFile file, const ControlModel& model)
      : file_{std::move(file)}, has_lamp_{model.family == HidFamily::powermate}, decoder_{model} {}
  ~EvdevPort() override {
    if (started_)
      light(false);
  }

private:
  Result<> do_start() override {
    started_ = true;
    light(true);
    return {};
  }
  int do_descriptor() const override { return file_.descriptor(); }

  Result<bool> do_read(std::optional<HidReading>& reading) override {
    reading.reset();
    HAL_TRY(const auto event, file_.next());
    if (!event)
      return false;
    reading = decoder_.decode(*event);
    return true;
  }

  void light(bool on) {
    if (!has_lamp_)
      return;
    input_event lamp{};
    lamp.type = EV_MSC;
    lamp.code = MSC_PULSELED;
    lamp.value = on ? 0xff : 0; // bits 0–7: brightness; the rest would let it pulse
    [[maybe_unused]] const ssize_t written = ::write(file_.descriptor(), &lamp, sizeof lamp);
  }

  EvdevFile file_;
  const bool has_lamp_;
  KeyDecoder decoder_;
  bool started_ = false;
};

} // namespace

Result<std::unique_ptr<ControlPort>> open_evdev_port(const HidNode& node,
                                                     const ControlModel& model) {
  HAL_TRY(auto file, EvdevFile::open(node.node));
  return std::make_unique<EvdevPort>(std::move(file), model);
}

} // namespace octascope::hal::linux_backend
