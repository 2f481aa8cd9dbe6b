#include "hal/linux/hid/controls/hid_controls.h"

#include <algorithm>
#include <cerrno>
#include <utility>

#include <fmt/format.h>
#include <poll.h>

#include "hal/linux/system/system_error.h"

namespace octascope::hal::linux_backend {

namespace {

constexpr Duration longest_wait_for_udev = std::chrono::seconds{3}; // at the machine's start

constexpr std::size_t most_files = ControlBoard::most_ports + 2; // and the two watches

std::string found_instead(const std::vector<HidNode>& nodes) {
  std::string list;
  for (const HidNode& node : nodes)
    if (!node.evdev) // most devices have a node of each kind: one is enough to name them
      list += fmt::format("{}{} {}", list.empty() ? "" : ", ", usb_id(node.vendor, node.product),
                          node.name);
  return list.empty() ? "no HID device" : list;
}

} // namespace

HidControls::HidControls(Clock& clock, std::vector<ControlModel> models)
    : clock_(clock), models_(std::move(models)) {
  ports_.reserve(ControlBoard::most_ports);
}

HidControls::~HidControls() {
  do_close();
}

std::vector<ServingControl> HidControls::serving() const {
  const std::lock_guard lock{serving_guard_};
  return serving_;
}

std::vector<std::string> HidControls::complaints() const {
  const std::lock_guard lock{serving_guard_};
  return complaints_;
}

Result<> HidControls::do_open() {
  // Watched before they are looked for: what is plugged in between is not missed.
  Result<> opened = watch().and_then([this] { return open_all(); });
  // Its node is there, and about to be given to our group.
  for (const TimePoint latest = clock_.now() + longest_wait_for_udev;
       !opened && opened.error().code == ErrorCode::absent && udev_is_at_work() &&
       clock_.now() < latest;
       opened = open_all())
    clock_.sleep_for(std::chrono::milliseconds{50});
  if (!opened) {
    do_close();
    return opened;
  }
  set_state(DeviceState::ready);
  return {};
}

Result<> HidControls::watch() {
  auto hidraw = DeviceWatch::on("hidraw");
  auto input = DeviceWatch::on("input");
  if (!hidraw || !input)
    return tl::make_unexpected(hidraw ? input.error() : hidraw.error());
  hidraw_watch_ = std::move(*hidraw);
  input_watch_ = std::move(*input);
  return {};
}

Result<> HidControls::open_all() {
  board_.vacate();
  const std::vector<HidNode> nodes = survey_hid();
  std::vector<ServingControl> serving;
  std::vector<Error> refused;
  std::optional<Error> not_yet;
  for (const PluggedControl& control : known_controls(nodes, models_))
    open_one(control, serving, refused, not_yet);
  publish(std::move(serving), refused);
  if (!ports_.empty())
    return {};
  if (!refused.empty())
    return tl::make_unexpected(refused.front());
  if (not_yet)
    return tl::make_unexpected(*not_yet);
  return fail(ErrorCode::absent,
              "HID controls: found {}, expected a pedal or knob that is listed in docs/DEVICES.md "
              "(in /usr/share/doc/octascope); plug one in, or teach a new one with `octascope "
              "devices --learn`",
              found_instead(nodes));
}

void HidControls::open_one(const PluggedControl& control, std::vector<ServingControl>& serving,
                           std::vector<Error>& refused, std::optional<Error>& not_yet) {
  std::vector<Port> opened;
  for (const HidNode& node : control.nodes) {
    auto file = ControlPort::open(node, control.model);
    const Result<> started = file ? (*file)->start() : tl::make_unexpected(file.error());
    if (started)
      opened.push_back({std::move(*file), node.node});
    else if (started.error().code != ErrorCode::absent)
      refused.push_back(started.error());
    else // it went while we looked, or udev is not through with it
      not_yet = started.error();
  }
  if (opened.empty())
    return;
  const auto device = board_.add_device(control.model.switches, control.model.knobs);
  if (!device)
    return;
  for (Port& port : opened) {
    const auto on_board = board_.add_port(*device);
    if (!on_board)
      break;
    port.on_board = *on_board;
    ports_.push_back(std::move(port));
  }
  serving.push_back({control, board_.place(*device)});
}

void HidControls::publish(std::vector<ServingControl> serving, const std::vector<Error>& refused) {
  const std::lock_guard lock{serving_guard_};
  serving_ = std::move(serving);
  complaints_.clear();
  for (const Error& error : refused)
    complaints_.push_back(error.message);
  changes_.fetch_add(1, std::memory_order_acq_rel);
}

Result<std::size_t> HidControls::do_read(std::span<ControlEvent> events, Duration timeout) {
  const TimePoint deadline = clock_.now() + std::max(timeout, Duration{});
  for (bool looked = false;; looked = true) {
    if (lost_ && !released_ && board_.has_room()) {
      board_.release_all(clock_.now());
      released_ = true;
    }
    if (const std::size_t count = board_.take(events); count > 0)
      return count;
    if (lost_ && !events.empty()) {
      set_state(DeviceState::failed);
      return tl::make_unexpected(*lost_);
    }
    if (looked && clock_.now() >= deadline)
      return std::size_t{0};
    receive(std::min(deadline, board_.due().value_or(deadline)));
  }
}

// All that can be read, waiting until `until` for the first, and what is due.
void HidControls::receive(TimePoint until) {
  std::array<pollfd, most_files> files{};
  std::size_t count = 0;
  if (!lost_) {
    for (const Port& port : ports_)
      files[count++] = {port.file->descriptor(), POLLIN, 0};
    files[count++] = {hidraw_watch_->descriptor(), POLLIN, 0};
    files[count++] = {input_watch_->descriptor(), POLLIN, 0};
  }
  const Duration left = held_back_ ? Duration{} : std::max(until - clock_.now(), Duration{});
  constexpr std::int64_t ns_per_s = 1'000'000'000;
  const timespec timeout{left.count() / ns_per_s, left.count() % ns_per_s};
  const int ready = ::ppoll(files.data(), count, &timeout, nullptr);
  if (ready < 0 && errno != EINTR)
    clock_.sleep_for(std::chrono::milliseconds{1}); // no memory, for a moment
  if (lost_)
    return;
  // What is not ready costs no call. Where none is, all are looked at.
  const bool all = std::exchange(held_back_, false) || ready <= 0;
  bool changes = all;
  for (std::size_t i = 0; i < count; ++i) {
    if (!all && files[i].revents == 0)
      continue;
    if (i < ports_.size())
      read_port(ports_[i]);
    else
      changes = true;
  }
  if (board_.has_room())
    board_.settle(clock_.now());
  if (changes && !lost_)
    look_for_changes();
}

void HidControls::look_for_changes() {
  bool came = false;
  for (DeviceWatch* const watch : {&*hidraw_watch_, &*input_watch_})
    while (const auto change = watch->next({}))
      came |= change->kind != DeviceChange::Kind::removed && !change->node.empty() &&
              !is_open(change->node);
  if (came)
    look_for_new_ones();
}

void HidControls::read_port(Port& port) {
  std::optional<HidReading> reading;
  while (!lost_) {
    if (!board_.has_room()) {
      held_back_ = true; // some of it may lie in a library, where no file tells of it
      return;
    }
    const auto more = port.file->read(reading);
    if (!more) {
      lost_ = Error{ErrorCode::disconnected, "HID controls: " + more.error().message};
      return;
    }
    if (!*more)
      return;
    const TimePoint now = clock_.now();
    board_.settle(now);
    if (reading)
      board_.note(port.on_board, *reading, now);
  }
}

bool HidControls::is_open(const std::string& node) const {
  return std::ranges::find(ports_, node, &Port::node) != ports_.end();
}

bool HidControls::can_be_opened_now(const PluggedControl& control) const {
  return std::ranges::any_of(control.nodes, [&](const HidNode& node) {
    return !is_open(node.node) && ControlPort::open(node, control.model).has_value();
  });
}

void HidControls::look_for_new_ones() {
  const auto known = known_controls(survey_hid(), models_);
  if (!std::ranges::any_of(known, [&](const auto& c) { return can_be_opened_now(c); }) ||
      !board_.has_room())
    return;
  board_.release_all(clock_.now());
  close_ports();
  if (const auto opened = open_all(); !opened)
    lost_ = Error{ErrorCode::disconnected, opened.error().message};
}

void HidControls::close_ports() {
  for (const Port& port : ports_)
    port.file->finish();
  ports_.clear();
}

void HidControls::do_close() {
  close_ports();
  board_.clear();
  lost_.reset();
  released_ = false;
  held_back_ = false;
  hidraw_watch_.reset();
  input_watch_.reset();
  publish({}, {});
  set_state(DeviceState::absent);
}

} // namespace octascope::hal::linux_backend
