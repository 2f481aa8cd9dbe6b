// The known pedals, knobs and pucks. Only these are opened: an unknown keyboard must not control
// the microscope.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace octascope::hal::linux_backend {

enum class HidFamily : std::uint8_t {
  vec_pedal,     // byte 0, bit n: switch n
  philips_pedal, // as vec_pedal
  shuttle,       // ring, jog wheel, buttons
  space_mouse,   // six axes, two buttons
  surface_dial,
  mapped,    // a learned device: any bits of its reports
  powermate, // read through evdev, because the kernel's driver hides the raw reports
  keyboard,  // read through evdev and grabbed, so that it does not type into the console
};

// A learned switch's bit in a report; byte 0 is the report's ID if it has one.
struct SwitchBit {
  std::size_t byte = 0;
  std::uint8_t mask = 0;
  bool operator==(const SwitchBit&) const = default;
};

struct ControlModel {
  std::uint16_t vendor = 0, product = 0;
  std::string model; // stable, for choosing a profile: "vec_infinity"
  std::string name;  // for people
  HidFamily family = HidFamily::mapped;
  int switches = 0;
  int knobs = 0;
  std::string product_has = {};               // distinguishes models with the same vendor:product
  std::vector<std::uint16_t> keys = {};       // keyboard: the key of switch n; empty: any, switch 0
  std::vector<SwitchBit> bits = {};           // mapped: the bit of switch n
  std::optional<std::uint8_t> report_id = {}; // mapped: the report that has the bits
  unsigned first_button = 0;                  // shuttle: the bit of switch 0
  bool operator==(const ControlModel&) const = default;

  bool by_evdev() const { return family == HidFamily::powermate || family == HidFamily::keyboard; }
};

inline constexpr int most_switches = 32; // of all devices together

// In order of precedence, pedals before knobs before pucks: the first that is plugged in leads.
// Vendors, products and report bytes: docs/DEVICES.md.
std::vector<ControlModel> listed_control_models();

// "05f3:00ff", as in a control profile's list of devices.
std::string usb_id(std::uint16_t vendor, std::uint16_t product);

} // namespace octascope::hal::linux_backend
