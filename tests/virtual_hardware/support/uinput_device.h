// An input device without hardware, through /dev/uinput.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "hal/linux/system/file_descriptor.h"
#include "hal/result.h"

namespace octascope::tests {

// Why none can be made here; empty when one can.
std::string uinput_missing();

struct UinputAbility {
  std::uint16_t type; // linux/input-event-codes.h: EV_KEY …
  std::uint16_t code; // KEY_A …
};

// Threads: one at a time.
class UinputDevice {
public:
  // On USB, as far as it says. Waits until its node in /dev is there.
  static hal::Result<std::unique_ptr<UinputDevice>>
  plug_in(const char* name, std::uint16_t vendor, std::uint16_t product,
          std::span<const UinputAbility> abilities);
  ~UinputDevice(); // pulls it out

  hal::Result<> send(std::uint16_t type, std::uint16_t code, std::int32_t value);

  int descriptor() const { return file_.get(); }
  std::string event_node() const; // "/dev/input/event0"

private:
  UinputDevice() = default;
  bool allow(const UinputAbility& ability) const;

  hal::linux_backend::FileDescriptor file_;
  std::string folder_; // in sysfs
};

} // namespace octascope::tests
