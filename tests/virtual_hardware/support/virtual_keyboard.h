// A keyboard without hardware, through /dev/uinput.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "hal/linux/system/file_descriptor.h"
#include "hal/result.h"

namespace octascope::tests {

// Threads: one at a time.
class VirtualKeyboard {
public:
  // Waits until its node in /dev is there.
  static hal::Result<std::unique_ptr<VirtualKeyboard>> plug_in(std::uint16_t vendor,
                                                               std::uint16_t product);
  ~VirtualKeyboard(); // pulls it out

  // `key` as in linux/input-event-codes.h.
  hal::Result<> set(std::uint16_t key, bool is_down);

  // Does somebody have it for himself alone?
  bool is_grabbed() const;

  std::string event_node() const; // "/dev/input/event0"

private:
  VirtualKeyboard() = default;

  hal::linux_backend::FileDescriptor uinput_;
  std::string folder_; // in sysfs
};

} // namespace octascope::tests
