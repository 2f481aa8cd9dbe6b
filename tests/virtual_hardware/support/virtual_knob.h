// A Griffin PowerMate without hardware, through /dev/uinput: the kernel's driver for the real one
// makes the same input device (REL_DIAL, BTN_0, MSC_PULSELED), and hidraw never sees it.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "hal/linux/system/file_descriptor.h"
#include "hal/result.h"

namespace octascope::tests {

// Why none can be made here; empty when one can.
std::string virtual_knob_missing();

// Threads: one at a time.
class VirtualKnob {
public:
  // Waits until its node in /dev is there.
  static hal::Result<std::unique_ptr<VirtualKnob>> plug_in();
  ~VirtualKnob(); // pulls it out

  hal::Result<> turn(int detents);
  hal::Result<> press(bool down);
  // What the lamp was last told and nobody has asked for; waits up to 2 s.
  std::optional<int> lamp();

  std::string event_node() const; // "/dev/input/event0"

private:
  VirtualKnob() = default;
  hal::Result<> send(int type, int code, int value);

  hal::linux_backend::FileDescriptor uinput_;
  std::string folder_; // in sysfs
};

} // namespace octascope::tests
