#include "hal/linux/hid/keyboards/console_keyboards.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <linux/input-event-codes.h>

#include "hal/linux/hid/ports/control_port.h"
#include "hal/linux/hid/survey/hid_survey.h"

namespace octascope::hal::linux_backend {

namespace {

constexpr std::chrono::seconds second_try_after{2};
constexpr std::size_t most_told = 256; // a hand types no more between two pictures

// Of a keyboard's several nodes some have but a mouse or a loudness wheel.
bool has_keys(const EvdevFile& file) {
  for (std::uint16_t code = 0; code < KEY_CNT; ++code)
    if (key_of_keyboard(code) != 0 && file.has_key(code))
      return true;
  return false;
}

} // namespace

ConsoleKeyboards::ConsoleKeyboards(Clock& clock, std::vector<std::string> listed)
    : clock_{clock}, listed_{std::move(listed)} {}

std::vector<std::string> ConsoleKeyboards::serving() const {
  std::vector<std::string> nodes;
  for (const Keyboard& keyboard : keyboards_)
    nodes.push_back(keyboard.file.node());
  return nodes;
}

void ConsoleKeyboards::do_attend(bool ours) {
  if (ours == ours_)
    return;
  ours_ = ours;
  if (!ours) {
    for (Keyboard& keyboard : keyboards_)
      let_go(keyboard);
    keyboards_.clear();
    watch_.reset();
    complaints_.clear();
    return;
  }
  // Watched before they are looked for: what is plugged in between is not missed.
  if (auto watch = DeviceWatch::on("input"))
    watch_ = std::move(*watch);
  look_for_keyboards();
}

std::size_t ConsoleKeyboards::do_poll_events(std::span<DisplayEvent> events) {
  const std::size_t gone = std::erase_if(keyboards_, [this](Keyboard& keyboard) {
    if (read(keyboard))
      return false;
    let_go(keyboard);
    return true;
  });
  if (ours_)
    look_for_changes(gone > 0);
  const std::size_t count = std::min(events.size(), told_.size());
  std::copy_n(told_.begin(), count, events.begin());
  told_.erase(told_.begin(), told_.begin() + static_cast<std::ptrdiff_t>(count));
  return count;
}

// One that was pulled out and plugged in again between two polls has, as a rule, the same node: the
// watch told of it while the old one was still open.
void ConsoleKeyboards::look_for_changes(bool one_is_gone) {
  bool look = one_is_gone;
  look = look || ((!watch_ || !complaints_.empty()) && clock_.now() - looked_ >= second_try_after);
  if (watch_)
    while (const auto change = watch_->next({}))
      look = look || change->kind != DeviceChange::Kind::removed;
  if (look)
    look_for_keyboards();
}

void ConsoleKeyboards::look_for_keyboards() {
  looked_ = clock_.now();
  complaints_.clear();
  for (const HidNode& node : survey_hid()) {
    const bool is_open = std::ranges::any_of(
        keyboards_, [&](const Keyboard& keyboard) { return keyboard.file.node() == node.node; });
    if (!node.evdev || is_open || !is_listed(usb_id(node.vendor, node.product)))
      continue;
    auto file = EvdevFile::open(node.node);
    if (!file && file.error().code != ErrorCode::absent) // it may go while we look
      complaints_.push_back(fmt::format("keyboard {} ({}): {}{}", node.name,
                                        usb_id(node.vendor, node.product), file.error().message,
                                        remedy_of_control(node.node, file.error().code)));
    if (file && has_keys(*file))
      keyboards_.push_back({std::move(*file), {}});
  }
}

bool ConsoleKeyboards::is_listed(const std::string& usb) const {
  return std::ranges::find(listed_, usb) != listed_.end();
}

bool ConsoleKeyboards::read(Keyboard& keyboard) {
  while (told_.size() < most_told) {
    const auto event = keyboard.file.next();
    if (!event)
      return false;
    if (!*event)
      break;
    if (const auto told = keyboard.decoder.decode(**event, clock_.now()))
      told_.push_back(*told);
  }
  return true;
}

void ConsoleKeyboards::let_go(Keyboard& keyboard) {
  while (const auto released = keyboard.decoder.release_one(clock_.now()))
    told_.push_back(*released);
}

} // namespace octascope::hal::linux_backend
