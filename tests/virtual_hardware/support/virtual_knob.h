// A Griffin PowerMate without hardware: the kernel's driver for the real one makes the same input
// device (REL_DIAL, BTN_0, MSC_PULSELED), and hidraw never sees it.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "hal/result.h"
#include "tests/virtual_hardware/support/uinput_device.h"

namespace octascope::tests {

// Pulled out when destroyed. Threads: one at a time.
class VirtualKnob {
public:
  static hal::Result<std::unique_ptr<VirtualKnob>> plug_in();

  hal::Result<> turn(int detents);
  hal::Result<> press(bool down);
  // What the lamp was last told and nobody has asked for; waits up to 2 s.
  std::optional<int> lamp();

  std::string event_node() const { return device_->event_node(); }

private:
  explicit VirtualKnob(std::unique_ptr<UinputDevice> device) : device_{std::move(device)} {}

  std::unique_ptr<UinputDevice> device_;
};

} // namespace octascope::tests
