// One open video node: its identity, the formats it offers, and the format it is set to.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "hal/line_camera.h"
#include "hal/linux/system/file_descriptor.h"
#include "hal/linux/v4l2/format_negotiation.h"
#include "hal/linux/v4l2/sensor_window.h"
#include "hal/result.h"

namespace octascope::hal::linux_backend {

struct NodeIdentity {
  std::string node;        // "/dev/video0"
  std::string card;        // the manufacturer's name for it
  std::string driver;      // the kernel driver
  std::string bus;         // where it is plugged in: unchanged by a replug into the same socket
  std::string camera = {}; // the individual camera, independent of the socket (camera_identity.h)
};

// Threads: one thread at a time. Errors name the node.
class CaptureNode {
public:
  // Opens the node in non-blocking mode. ErrorCode::unsupported: it does not capture images into
  // mapped buffers (an output, metadata, a memory-to-memory converter).
  static Result<CaptureNode> open(const std::string& node);

  const NodeIdentity& identity() const { return identity_; }
  const FileDescriptor& file() const { return file_; }

  Result<std::vector<OfferedFormat>> formats() const;

  // The first of the ranked formats that the driver accepts; only tries, sets nothing.
  Result<FormatRequest> choose_format(const LineFormat& wanted) const;

  // Sets the format and returns what the driver gave, checked against the request.
  Result<GivenFormat> set_format(const FormatRequest& request) const;

  Result<> select_input(int input) const;

  // Sets exactly this window, or returns an Error with the one that the driver chose.
  Result<> set_window(const SensorWindow& window) const;

private:
  CaptureNode(FileDescriptor file, NodeIdentity identity)
      : file_{std::move(file)}, identity_{std::move(identity)} {}

  std::vector<OfferedSize> sizes(std::uint32_t code) const;
  Error named(Error error) const;

  FileDescriptor file_;
  NodeIdentity identity_;
};

} // namespace octascope::hal::linux_backend
