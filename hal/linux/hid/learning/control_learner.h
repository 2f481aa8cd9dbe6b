// Finds out what a control that nobody knows sends, from somebody who presses its switches one
// after the other. Pure.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hal/linux/hid/decoders/key_decoder.h"
#include "hal/linux/hid/models/control_model.h"

namespace octascope::hal::linux_backend {

// A switch is a bit that rises and falls alone; a byte of which several bits change at once is a
// value (an axis, a wheel, a key's number), and none of its bits is a switch.
class ControlLearner {
public:
  // `numbered`: its reports begin with an ID.
  explicit ControlLearner(bool numbered) : numbered_(numbered) {}

  // What has changed, for people; empty: nothing.
  std::string note(std::span<const std::uint8_t> report);
  std::string note(const KeyEvent& event);

  // What was learned so far: in the order of their first presses. A control that types is known by
  // its keys, else by its bits. Nothing: no switch was pressed and let go yet.
  std::optional<ControlModel> model(std::uint16_t vendor, std::uint16_t product,
                                    std::string name) const;

private:
  struct Bit {
    SwitchBit place;
    std::uint8_t report_id = 0;
    bool fell = false;
  };
  struct Report {
    std::vector<std::uint8_t> last;
    std::vector<bool> is_value;
  };
  std::string note_byte(Report& report, std::uint8_t id, std::size_t byte, std::uint8_t now);

  bool numbered_;
  std::map<std::uint8_t, Report> reports_; // by ID
  std::vector<Bit> bits_;
  std::vector<std::uint16_t> keys_;
};

// Does a report descriptor number its reports?
bool has_report_ids(std::span<const std::uint8_t> descriptor);

} // namespace octascope::hal::linux_backend
