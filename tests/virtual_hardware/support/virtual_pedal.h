// A HID device without hardware, through the kernel's /dev/uhid: pedals, pucks, jog wheels, typing
// foot switches. Its reports go the way of a plugged one's: HID core, hidraw, input.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hal/linux/system/file_descriptor.h"
#include "hal/result.h"

namespace octascope::tests {

// Why none can be made here; empty when one can.
std::string virtual_pedal_missing();

struct VirtualPedalKind {
  std::uint16_t vendor = 0, product = 0;
  std::string name;
  std::vector<std::uint8_t> descriptor; // HID report descriptor
  std::string phys = "usb-octascope-bench-1/input0";
};

// Descriptors that give reports of the devices' sizes and IDs (hardware.md).
VirtualPedalKind vec_pedal();       // 2 bytes
VirtualPedalKind philips_pedal();   // 8 bytes
VirtualPedalKind shuttle_xpress();  // 5 bytes
VirtualPedalKind shuttle_pro();     // likewise
VirtualPedalKind space_navigator(); // reports 1, 2, 3; output report 4
VirtualPedalKind space_mouse();     // report 1 with six axes, 3
VirtualPedalKind surface_dial();    // report 1
VirtualPedalKind pcsensor_pedal(std::string name = "PCsensor FootSwitch"); // keyboard, report 1

// Threads: one at a time.
class VirtualPedal {
public:
  // Waits until its driver is done and its nodes in /dev are there.
  static hal::Result<std::unique_ptr<VirtualPedal>> plug_in(const VirtualPedalKind& kind);
  ~VirtualPedal(); // pulls it out

  // With the report's ID in front where the descriptor has IDs.
  hal::Result<> send(std::span<const std::uint8_t> report);
  hal::Result<> send(std::initializer_list<std::uint8_t> report) {
    return send(std::span{report.begin(), report.size()});
  }

  // The oldest output report that the computer has sent and nobody has asked for; waits up to 2 s.
  std::optional<std::vector<std::uint8_t>> output();

  std::string hidraw_node() const; // "/dev/hidraw0"; empty: none
  std::string event_node() const;  // "/dev/input/event0"; empty: none

private:
  VirtualPedal() = default;
  std::string sysfs_folder() const;

  hal::linux_backend::FileDescriptor uhid_;
  std::string unique_; // its serial number, by which it is found in sysfs
  std::string id_;     // ":05F3:00FF."
};

} // namespace octascope::tests
