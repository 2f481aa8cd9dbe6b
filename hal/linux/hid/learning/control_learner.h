// Learns what an unknown control sends while the user presses its switches one after the other.
// Pure.
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

// A switch is a bit that is set and cleared alone. A byte of which several bits change at once is a
// value (an axis, a wheel, a key code), and none of its bits is a switch.
class ControlLearner {
public:
  // `numbered`: the reports begin with an ID.
  explicit ControlLearner(bool numbered) : numbered_(numbered) {}

  // Returns what has changed, for people; empty if nothing.
  std::string note(std::span<const std::uint8_t> report);
  std::string note(const KeyEvent& event);

  // The model learned so far, with switches in the order of their first presses: keys if the
  // control sent any, else bits. Empty until a key has been pressed, or a bit set and cleared.
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

// Whether a report descriptor uses report IDs.
bool has_report_ids(std::span<const std::uint8_t> descriptor);

} // namespace octascope::hal::linux_backend
