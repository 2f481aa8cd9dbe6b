#include "hal/linux/hid/decoders/key_decoder.h"

#include <algorithm>

#include <linux/input-event-codes.h>

namespace octascope::hal::linux_backend {

namespace {
constexpr std::int32_t released = 0, pressed = 1; // 2: held so long that it repeats
constexpr std::int32_t most_detents = 1000;       // no hand turns further between two events
} // namespace

KeyDecoder::KeyDecoder(const ControlModel& model)
    : family_(model.family), keys_(model.keys), any_down_(KEY_CNT) {
  if (family_ == HidFamily::powermate)
    keys_ = {BTN_0};
}

std::optional<HidReading> KeyDecoder::decode(const KeyEvent& event) {
  if (event.type == EV_KEY && (event.value == pressed || event.value == released))
    return key(event.code, event.value == pressed);
  if (event.type == EV_REL && event.code == REL_DIAL && family_ == HidFamily::powermate)
    return HidReading{.knob = std::clamp(event.value, -most_detents, most_detents)};
  return std::nullopt;
}

std::optional<HidReading> KeyDecoder::key(std::uint16_t code, bool down) {
  if (!keys_.empty()) {
    const auto place = std::ranges::find(keys_, code);
    if (place == keys_.end())
      return std::nullopt;
    const std::uint32_t bit = 1U << (place - keys_.begin());
    down_ = down ? down_ | bit : down_ & ~bit;
    return HidReading{.switches = down_};
  }
  if (code >= any_down_.size() || any_down_[code] == down)
    return std::nullopt;
  any_down_[code] = down;
  down_ = down ? down_ + 1 : down_ - 1;
  return HidReading{.switches = down_ > 0 ? 1U : 0U};
}

} // namespace octascope::hal::linux_backend
