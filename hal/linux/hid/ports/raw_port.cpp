#include "hal/linux/hid/ports/raw_port.h"

#include <array>
#include <utility>

#include "hal/linux/hid/raw/raw_device.h"
#include "hal/linux/hid/raw/report_reader.h"

namespace octascope::hal::linux_backend {

namespace {

class RawPort final : public ControlPort {
public:
  RawPort(std::unique_ptr<RawDevice> device, const ControlModel& model)
      : device_{std::move(device)}, has_lamp_{model.family == HidFamily::space_mouse},
        decoder_{make_hid_decoder(model)} {}
  ~RawPort() override {
    const bool was_read = reader_ != nullptr;
    reader_.reset();
    if (was_read)
      light(false);
  }

private:
  Result<> do_start() override {
    light(true); // before the device is the reader's
    auto reader = ReportReader::start(*device_);
    if (!reader) {
      light(false);
      return tl::make_unexpected(std::move(reader.error()));
    }
    reader_ = std::move(*reader);
    return {};
  }
  int do_descriptor() const override { return reader_->descriptor(); }

  Result<bool> do_read(std::optional<HidReading>& reading) override {
    reading.reset();
    HAL_TRY(const auto report, reader_->take());
    if (report.empty())
      return false;
    reading = decoder_->decode(report);
    return true;
  }

  void do_finish() override { reader_->finish(); }

  void light(bool on) {
    if (has_lamp_)
      device_->write(std::array<std::uint8_t, 2>{4, on ? std::uint8_t{1} : std::uint8_t{0}});
  }

  std::unique_ptr<RawDevice> device_; // outlives its reader
  const bool has_lamp_;
  std::unique_ptr<HidDecoder> decoder_;
  std::unique_ptr<ReportReader> reader_;
};

} // namespace

Result<std::unique_ptr<ControlPort>> open_raw_port(const HidNode& node, const ControlModel& model) {
  HAL_TRY(auto device, RawDevice::open(node.node));
  return std::make_unique<RawPort>(std::move(device), model);
}

} // namespace octascope::hal::linux_backend
