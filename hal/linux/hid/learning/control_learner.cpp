#include "hal/linux/hid/learning/control_learner.h"

#include <algorithm>
#include <bit>
#include <utility>

#include <fmt/format.h>
#include <linux/input-event-codes.h>

namespace octascope::hal::linux_backend {

std::string ControlLearner::note(std::span<const std::uint8_t> bytes) {
  if (bytes.empty())
    return {};
  const std::uint8_t id = numbered_ ? bytes[0] : std::uint8_t{0};
  Report& report = reports_[id];
  if (report.last.size() < bytes.size()) { // a control at rest sends zeros, if anything
    report.last.resize(bytes.size());
    report.is_value.resize(bytes.size());
  }
  std::string text;
  for (std::size_t byte = numbered_ ? 1 : 0; byte < bytes.size(); ++byte)
    if (bytes[byte] != report.last[byte])
      text += (text.empty() ? "" : ", ") + note_byte(report, id, byte, bytes[byte]);
  return text;
}

std::string ControlLearner::note_byte(Report& report, std::uint8_t id, std::size_t byte,
                                      std::uint8_t now) {
  const std::uint8_t before = std::exchange(report.last[byte], now);
  const auto changed = static_cast<std::uint8_t>(before ^ now);
  std::string text = fmt::format("byte {}: {:02x} -> {:02x}", byte, before, now);
  const auto is_of_this_byte = [&](const Bit& bit) {
    return bit.report_id == id && bit.place.byte == byte;
  };
  if (!std::has_single_bit(changed)) {
    report.is_value[byte] = true;
    std::erase_if(bits_, is_of_this_byte);
  }
  if (report.is_value[byte])
    return text + " (a value)";
  auto place = std::ranges::find_if(
      bits_, [&](const Bit& bit) { return is_of_this_byte(bit) && bit.place.mask == changed; });
  if (place == bits_.end()) {
    if ((now & changed) == 0)
      return text; // it was down before anybody looked
    place = bits_.insert(bits_.end(), Bit{{byte, changed}, id, false});
  }
  if ((now & changed) == 0)
    place->fell = true;
  return fmt::format("{} (bit 0x{:02x}: switch {} {})", text, changed, place - bits_.begin() + 1,
                     (now & changed) != 0 ? "down" : "up");
}

std::string ControlLearner::note(const KeyEvent& event) {
  if (event.type != EV_KEY || event.code >= BTN_MISC || event.value > 1)
    return {};
  auto place = std::ranges::find(keys_, event.code);
  if (place == keys_.end())
    place = keys_.insert(keys_.end(), event.code);
  return fmt::format("key {} (switch {} {})", event.code, place - keys_.begin() + 1,
                     event.value != 0 ? "down" : "up");
}

std::optional<ControlModel> ControlLearner::model(std::uint16_t vendor, std::uint16_t product,
                                                  std::string name) const {
  ControlModel model{.vendor = vendor,
                     .product = product,
                     .model = "learned",
                     .name = std::move(name),
                     .family = keys_.empty() ? HidFamily::mapped : HidFamily::keyboard};
  if (keys_.empty()) {
    for (const Bit& bit : bits_) {
      // One report is listened to: that of the first switch.
      if (bit.fell && (model.bits.empty() || bit.report_id == model.report_id.value_or(0)) &&
          model.bits.size() < most_switches) {
        model.bits.push_back(bit.place);
        if (numbered_)
          model.report_id = bit.report_id;
      }
    }
  } else {
    model.keys.assign(keys_.begin(),
                      keys_.begin() + std::min<std::ptrdiff_t>(std::ssize(keys_), most_switches));
  }
  model.switches = static_cast<int>(std::max(model.bits.size(), model.keys.size()));
  return model.switches > 0 ? std::optional{std::move(model)} : std::nullopt;
}

// Short items of a descriptor: the two low bits of the first byte say how many follow; 0x84 is the
// report ID's tag and type (HID 1.11, 6.2.2). A long item says its size in its second byte.
bool has_report_ids(std::span<const std::uint8_t> descriptor) {
  for (std::size_t i = 0; i < descriptor.size();) {
    const std::uint8_t item = descriptor[i];
    if (item == 0xfe) {
      i += 3U + (i + 1 < descriptor.size() ? descriptor[i + 1] : 0U);
      continue;
    }
    if ((item & 0xfc) == 0x84)
      return true;
    i += 1U + ((item & 3U) == 3U ? 4U : item & 3U);
  }
  return false;
}

} // namespace octascope::hal::linux_backend
