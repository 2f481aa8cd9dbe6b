// An open input device (libevdev), grabbed: no other program gets its events.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "hal/linux/hid/decoders/key_decoder.h"
#include "hal/linux/system/file_descriptor.h"
#include "hal/result.h"

struct libevdev;

namespace octascope::hal::linux_backend {

// Threads: one at a time.
class EvdevFile {
public:
  // Grabs the device until it is closed. ErrorCode::busy: another program has grabbed it.
  static Result<EvdevFile> open(const std::string& node);

  int descriptor() const { return file_.get(); }
  const std::string& node() const { return node_; }
  bool has_key(std::uint16_t code) const;

  // The next event; empty if there is none now. Does not wait; allocates only if the device is
  // gone. After an overflow of the kernel's buffer, returns the changes that were missed.
  Result<std::optional<KeyEvent>> next();

private:
  struct Freer {
    void operator()(libevdev* device) const;
  };

  EvdevFile(FileDescriptor file, std::unique_ptr<libevdev, Freer> device, std::string node);

  FileDescriptor file_; // outlives the device
  std::unique_ptr<libevdev, Freer> device_;
  std::string node_;
  bool catching_up_ = false;
};

} // namespace octascope::hal::linux_backend
