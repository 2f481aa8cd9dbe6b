// One video node, opened: what it is, what it offers, and the format it is set to.
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
  std::string card;        // what the maker calls it
  std::string driver;      // what drives it
  std::string bus;         // where it is plugged in: the same after a replug into the same socket
  std::string camera = {}; // which one it is, wherever it is plugged in (camera_identity.h)
};

// Threads: one thread at a time. Errors name the node.
class CaptureNode {
public:
  // Opened without blocking. ErrorCode::unsupported for a node that brings no pictures by mapped
  // buffers: an output, metadata, a memory-to-memory converter.
  static Result<CaptureNode> open(const std::string& node);

  const NodeIdentity& identity() const { return identity_; }
  const FileDescriptor& file() const { return file_; }

  Result<std::vector<OfferedFormat>> formats() const;

  // The first of the ranked formats that the driver would give; asks, and sets nothing.
  Result<FormatRequest> choose_format(const LineFormat& wanted) const;

  // What the driver gave, checked against the request.
  Result<GivenFormat> set_format(const FormatRequest& request) const;

  Result<> select_input(int input) const;

  // Exactly this window, or an Error with what the driver made of it.
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
