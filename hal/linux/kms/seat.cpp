#include "hal/linux/kms/seat.h"

#include <cerrno>
#include <cstdlib>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>
#include <xf86drm.h>

extern "C" {
#include <libseat.h>
}

#include "hal/linux/system/system_error.h"

namespace octascope::hal::linux_backend::kms {

namespace {

constexpr std::chrono::seconds patience{2};

int milliseconds(Duration duration) {
  return static_cast<int>(std::chrono::ceil<std::chrono::milliseconds>(duration).count());
}

tl::unexpected<Error> taken(std::string_view reason) {
  return fail(ErrorCode::busy,
              "kms display: the card is another program's ({}), expected it to be free to show "
              "pictures; `sudo fuser -v /dev/dri/card*` names who has it (a desktop, a login "
              "screen, another octascope): end that program, or choose --display window",
              reason);
}

// Where libseat is asked without need it makes a manager of itself: a child process that inherits
// every device we have open. So it is asked only where somebody can answer: seatd by its socket,
// logind in a session of its own, or what the environment names.
bool has_manager() {
  if (std::getenv("LIBSEAT_BACKEND") != nullptr)
    return true;
  const char* const socket = std::getenv("SEATD_SOCK");
  if (::access(socket != nullptr ? socket : "/run/seatd.sock", F_OK) == 0)
    return true;
  return std::getenv("XDG_SESSION_ID") != nullptr && ::access("/run/systemd/seats", F_OK) == 0;
}

tl::unexpected<Error> no_manager(std::string_view found) {
  return fail(ErrorCode::absent,
              "kms display: no manager of seats answers ({}), expected seatd or logind; start "
              "octascope from a console login or by its systemd unit, or `sudo apt install seatd`, "
              "or as root with --no-seat",
              found);
}

class ManagedSeat final : public Seat {
public:
  ~ManagedSeat() override {
    if (seat_ != nullptr)
      libseat_close_seat(seat_);
  }

  Result<> open() {
    libseat_set_log_level(LIBSEAT_LOG_LEVEL_SILENT); // its errors come to us, in our words
    seat_ = libseat_open_seat(&listener_, this);
    if (seat_ == nullptr)
      return no_manager(std::generic_category().message(errno));
    for (Duration waited{}; !active(); waited += slice) {
      if (broken_ || waited >= patience)
        return fail(ErrorCode::busy,
                    "kms display: another console is in front of seat {}, expected ours; switch to "
                    "it (Ctrl-Alt-F1 and on)",
                    libseat_seat_name(seat_));
      wait(slice);
    }
    return {};
  }

  Result<SeatDevice> open_device(const std::string& node) override {
    int descriptor = -1;
    const int id = libseat_open_device(seat_, node.c_str(), &descriptor);
    if (id == -1)
      return system_failure(node, "opening it through the seat", errno);
    return SeatDevice{FileDescriptor{descriptor}, id};
  }

  void close_device(SeatDevice device) override { libseat_close_device(seat_, device.id); }

  // The manager has made us master when it opened the card, and does again on every return.
  Result<> take_card(const SeatDevice& card) override {
    if (drmIsMaster(card.file.get()) == 0)
      return taken("the manager of seats could not take it");
    return {};
  }

  bool active() override {
    // What has come is handled; an answer of our own may bring more.
    for (int handled = 1; handled > 0;)
      handled = dispatch();
    const bool was_away = std::exchange(was_away_, false);
    return enabled_ && !broken_ && !was_away;
  }

  void wait(Duration timeout) override {
    if (broken_) {
      ::poll(nullptr, 0, milliseconds(timeout));
      return;
    }
    pollfd file{libseat_get_fd(seat_), POLLIN, 0};
    ::poll(&file, 1, milliseconds(timeout));
  }

private:
  static constexpr std::chrono::milliseconds slice{50};

  int dispatch() {
    const int handled = libseat_dispatch(seat_, 0);
    if (handled == -1 && errno != EAGAIN && errno != EINTR)
      broken_ = true; // the manager has gone
    return handled;
  }

  libseat_seat_listener listener_{
      [](libseat*, void* self) { static_cast<ManagedSeat*>(self)->enabled_ = true; },
      [](libseat* seat, void* self) {
        static_cast<ManagedSeat*>(self)->enabled_ = false;
        static_cast<ManagedSeat*>(self)->was_away_ = true;
        libseat_disable_seat(seat); // the manager waits for this answer
      }};
  libseat* seat_ = nullptr;
  bool enabled_ = false;
  bool was_away_ = false; // since active() was asked
  bool broken_ = false;
};

class PlainSeat final : public Seat {
public:
  Result<SeatDevice> open_device(const std::string& node) override {
    auto file = linux_backend::open_device(node, O_RDWR | O_NONBLOCK);
    if (!file)
      return tl::make_unexpected(file.error());
    return SeatDevice{*std::move(file), -1};
  }

  void close_device(SeatDevice) override {}

  // The kernel says EBUSY to root and EACCES to others where somebody else is master.
  Result<> take_card(const SeatDevice& card) override {
    if (drmIsMaster(card.file.get()) != 0 || drmSetMaster(card.file.get()) == 0)
      return {};
    return taken(std::generic_category().message(errno));
  }

  bool active() override { return true; }
  void wait(Duration timeout) override { ::poll(nullptr, 0, milliseconds(timeout)); }
};

} // namespace

Result<std::unique_ptr<Seat>> open_managed_seat() {
  if (!has_manager())
    return no_manager("neither its socket nor a session");
  auto seat = std::make_unique<ManagedSeat>();
  HAL_CHECK(seat->open());
  return seat;
}

std::unique_ptr<Seat> open_plain_seat() {
  return std::make_unique<PlainSeat>();
}

} // namespace octascope::hal::linux_backend::kms
