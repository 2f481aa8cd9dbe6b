// A device that speaks in raw reports, listed, opened, read and written through hidapi.
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

// All that are plugged in, in the order of their numbers; nothing is opened. Any thread.
std::vector<RawNode> list_raw_nodes();

// Threads: one at a time; opening on any.
class RawDevice {
public:
  // ErrorCode::denied, busy, absent …
  static Result<std::unique_ptr<RawDevice>> open(const std::string& node);

  const std::string& node() const { return node_; }

  // The size of the next report, which begins with its ID where the device numbers its reports; 0:
  // none came within `timeout`. ErrorCode::disconnected. No allocation unless the device is gone.
  Result<std::size_t> read(std::span<std::uint8_t> report, std::chrono::milliseconds timeout);

  // An output report, its ID in front; whether it was sent.
  bool write(std::span<const std::uint8_t> report);

  // Empty: the kernel does not tell.
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
