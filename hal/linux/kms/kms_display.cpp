#include "hal/linux/kms/kms_display.h"

#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "hal/linux/kms/draw_surface.h"
#include "hal/linux/kms/drm/card_survey.h"
#include "hal/linux/kms/mode/output_choice.h"
#include "hal/linux/kms/mode/visible_frame.h"
#include "hal/linux/kms/output.h"
#include "hal/linux/kms/seat.h"

namespace octascope::hal::linux_backend {

using namespace kms;

namespace {

// How long a present() that shows nothing takes, so that a loop of them costs nothing.
constexpr std::chrono::milliseconds paused_wait{100};

Result<std::unique_ptr<Seat>> open_seat(KmsConfig::SeatUse use) {
  if (use == KmsConfig::SeatUse::plain)
    return open_plain_seat();
  auto managed = open_managed_seat();
  // "Another console is in front" is an answer; only where nobody answers may we help ourselves.
  if (managed || use == KmsConfig::SeatUse::managed || managed.error().code != ErrorCode::absent)
    return managed;
  return open_plain_seat();
}

} // namespace

// From seat to surface, taken down in the opposite order.
struct KmsDisplay::Session {
  std::unique_ptr<Seat> seat;
  Card card;
  OutputChoice choice;
  SeatDevice device;
  std::unique_ptr<DrawSurface> surface;
  std::optional<Output> output;
  VisibleFrame frame;
  gbm_bo* shown = nullptr;
  bool paused = false;

  Session() = default;
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  ~Session() {
    output.reset(); // first: the buffers must be off the screen before they go
    frame.destroy();
    surface.reset();
    if (device.file)
      seat->close_device(std::move(device));
  }

  Result<> open(const KmsConfig& config, Clock& clock) {
    OutputRequest wanted{config.connector, {}, config.atomic};
    HAL_TRY(auto mode, parse_mode_request(config.mode));
    wanted.mode = mode;
    auto opened = open_seat(config.seat);
    if (!opened)
      return tl::make_unexpected(opened.error());
    seat = *std::move(opened);
    HAL_CHECK(choose(wanted));
    HAL_CHECK(seat->take_card(device));
    HAL_TRY(const auto part, visible_part(choice.mode.width, choice.mode.height, config.overscan));
    auto shown_with = show_black(part, true, clock);
    // A layout that draws best may be more than the output can read at this mode.
    if (!shown_with && surface && surface->uses_modifiers())
      shown_with = show_black(part, false, clock);
    return shown_with;
  }

  // Opens all cards, keeps the one that is chosen.
  Result<> choose(const OutputRequest& wanted) {
    std::vector<Card> cards;
    std::vector<SeatDevice> devices;
    for (const std::string& node : card_nodes()) {
      auto opened = seat->open_device(node);
      if (opened) {
        cards.push_back(read_card(opened->file, node));
        devices.push_back(*std::move(opened));
      } else {
        cards.emplace_back().node = node;
        cards.back().problem = opened.error();
        devices.emplace_back();
      }
    }
    const auto chosen = choose_output(cards, wanted);
    for (std::size_t i = 0; i < devices.size(); ++i)
      if (devices[i].file && (!chosen || i != chosen->card))
        seat->close_device(std::move(devices[i]));
    if (!chosen)
      return tl::make_unexpected(chosen.error());
    choice = *chosen;
    card = std::move(cards[choice.card]);
    device = std::move(devices[choice.card]);
    return {};
  }

  Result<> show_black(const Rectangle& part, bool modifiers, Clock& clock) {
    output.reset();
    frame.destroy();
    surface.reset();
    const int width = choice.mode.width;
    const int height = choice.mode.height;
    auto made = DrawSurface::create(
        device.file, {width, height, card, find_plane(card, choice.plane), modifiers});
    if (!made)
      return tl::make_unexpected(made.error());
    surface = *std::move(made);
    HAL_CHECK(frame.create(width, height, part));
    output.emplace(clock, *seat, device, card, choice);
    frame.copy_to_screen();
    HAL_TRY(auto shown_at, show());
    if (!shown_at)
      return fail(ErrorCode::busy,
                  "{}: another program took the card while it was opened; end that program; it is "
                  "tried again by itself",
                  output->name());
    return {};
  }

  // Empty: nothing was shown, the card is not ours now.
  Result<std::optional<FlipTimes>> show() {
    HAL_TRY(auto picture, surface->take_picture(output->takes_fences()));
    auto times = output->show(picture);
    if (times && *times)
      surface->release(std::exchange(shown, picture.buffer));
    else
      surface->release(picture.buffer);
    return times;
  }

  // Is the card ours? If not, a while passes.
  bool may_show() {
    if (seat->active()) {
      if (!paused)
        return true;
      if (seat->take_card(device)) {
        paused = false;
        output->want_mode();
        return true;
      }
    }
    paused = true;
    seat->wait(paused_wait);
    return false;
  }

  std::string describe() const {
    const Connector& connector = card.connectors[choice.connector];
    return fmt::format("{}{}, {}, {}", output->name(),
                       connector.monitor.empty() ? "" : " (" + connector.monitor + ")",
                       to_text(choice.mode), choice.atomic ? "atomic" : "legacy");
  }
};

KmsDisplay::KmsDisplay(Clock& clock, KmsConfig config, std::unique_ptr<KeySource> keys)
    : clock_{clock}, config_{std::move(config)}, keys_{std::move(keys)} {}

KmsDisplay::~KmsDisplay() {
  do_close();
}

Result<> KmsDisplay::do_open(const DisplayConfig&) {
  auto session = std::make_unique<Session>();
  HAL_CHECK(session->open(config_, clock_));
  session_ = std::move(session);
  description_ = session_->describe();
  refresh_period_ = from_seconds(1 / refresh_hz(session_->choice.mode));
  pacer_ = FlipPacer{refresh_period_, clock_.now()};
  flips_ = 0;
  attend(true);
  set_state(DeviceState::ready);
  return {};
}

int KmsDisplay::do_width() const {
  return session_ ? session_->frame.width() : 0;
}

int KmsDisplay::do_height() const {
  return session_ ? session_->frame.height() : 0;
}

// With margins there is one buffer, which is copied.
BackBuffer KmsDisplay::do_back_buffer() {
  if (!session_)
    return {};
  BackBuffer buffer = session_->surface->back_buffer();
  if (session_->frame.has_margins())
    buffer.holds = buffer.image - 1;
  return buffer;
}

Result<Flip> KmsDisplay::do_present() {
  if (!session_)
    return fail(ErrorCode::absent, "kms display: not open; open() it first");
  if (state() == DeviceState::failed)
    return fail(ErrorCode::disconnected, "kms display: lost; close() it and open() it again");
  if (auto there = session_->output->check(); !there)
    return lose(there.error());
  const bool ours = session_->may_show();
  attend(ours);
  if (!ours)
    return Flip{clock_.now(), flips_, clock_.now()};
  session_->frame.copy_to_screen();
  const auto shown = session_->show();
  if (!shown)
    return lose(shown.error());
  if (!*shown) {
    session_->paused = true;
    attend(false);
    return Flip{clock_.now(), flips_, clock_.now()};
  }
  const TimePoint completed = pacer_.completed(**shown);
  clock_.sleep_until(pacer_.next_allowed());
  return Flip{completed, ++flips_, (*shown)->submitted};
}

Result<Flip> KmsDisplay::lose(const Error& error) {
  set_state(DeviceState::failed);
  return tl::make_unexpected(error);
}

void KmsDisplay::attend(bool ours) {
  if (keys_)
    keys_->attend(ours);
}

void KmsDisplay::do_close() {
  attend(false);
  session_.reset();
  description_.clear();
  set_state(DeviceState::absent);
}

} // namespace octascope::hal::linux_backend
