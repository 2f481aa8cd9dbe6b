// A device with raw reports, listed, opened, read and written through hidapi.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "hal/linux/hid/raw/hidapi_library.h"
#include "hal/result.h"

struct hid_device_;

namespace octascope::hal::linux_backend {

struct RawNode {
  std::string node; // "/dev/hidraw0"
  std::uint16_t vendor = 0, product = 0;
  bool operator==(const RawNode&) const = default;
};

// All that are plugged in, by number; opens nothing. Any thread.
std::vector<RawNode> list_raw_nodes();

// Threads: one at a time; open() on any.
class RawDevice {
public:
  // ErrorCode::denied, busy, absent …
  static Result<std::unique_ptr<RawDevice>> open(const std::string& node);

  const std::string& node() const { return node_; }

  // Returns the size of the next report, or 0 if none arrives within `timeout`. The report begins
  // with its ID if the device uses report IDs. ErrorCode::disconnected: the device is gone; nothing
  // is allocated otherwise.
  Result<std::size_t> read(std::span<std::uint8_t> report, std::chrono::milliseconds timeout);

  // Sends an output report, which begins with its ID; false if it was not sent.
  bool write(std::span<const std::uint8_t> report);

  // Empty if it is not available.
  std::vector<std::uint8_t> report_descriptor() const;

private:
  struct Closer {
    void operator()(hid_device_* device) const;
  };
  explicit RawDevice(std::string node) : node_{std::move(node)} {}

  const HidapiLibrary library_; // outlives the device
  const std::string node_;
  std::unique_ptr<hid_device_, Closer> device_;
};

} // namespace octascope::hal::linux_backend
