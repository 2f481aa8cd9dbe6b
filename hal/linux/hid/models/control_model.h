// Which pedals, knobs and pucks octascope knows. Only these are opened: a strange keyboard must not
// steer the microscope.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace octascope::hal::linux_backend {

enum class HidFamily : std::uint8_t {
  vec_pedal,     // byte 0, bit n: switch n
  philips_pedal, // likewise
  shuttle,       // ring, jog wheel, buttons
  space_mouse,   // six axes, two buttons
  surface_dial,
  mapped,    // a learned device: any bits of its reports
  powermate, // by evdev: the kernel's driver keeps the bytes to itself
  keyboard,  // by evdev, grabbed: what it types must not reach the console
};

// Where a learned switch is in a report; byte 0 is the report's ID where there is one.
struct SwitchBit {
  std::size_t byte = 0;
  std::uint8_t mask = 0;
  bool operator==(const SwitchBit&) const = default;
};

struct ControlModel {
  std::uint16_t vendor = 0, product = 0;
  std::string model; // stable, for the choice of a profile: "vec_infinity"
  std::string name;  // for people
  HidFamily family = HidFamily::mapped;
  int switches = 0;
  int knobs = 0;
  std::string product_has = {};               // what tells models of one vendor:product apart
  std::vector<std::uint16_t> keys = {};       // keyboard: of switch n; empty: any is switch 0
  std::vector<SwitchBit> bits = {};           // mapped: of switch n
  std::optional<std::uint8_t> report_id = {}; // mapped: of the reports that have the bits
  unsigned first_button = 0;                  // shuttle: the bit of switch 0
  bool operator==(const ControlModel&) const = default;

  bool by_evdev() const { return family == HidFamily::powermate || family == HidFamily::keyboard; }
};

inline constexpr int most_switches = 32; // of all devices together

// In the order of precedence: the first that is plugged in is the leading one, pedals before knobs
// before pucks. Vendor, product and bytes: docs/DEVICES.md.
std::vector<ControlModel> listed_control_models();

// "05f3:00ff", as in a control profile's list of devices.
std::string usb_id(std::uint16_t vendor, std::uint16_t product);

} // namespace octascope::hal::linux_backend
