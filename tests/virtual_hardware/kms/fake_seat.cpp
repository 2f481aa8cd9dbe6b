#include "tests/virtual_hardware/kms/fake_seat.h"

#include <cerrno>
#include <deque>
#include <functional>
#include <map>

#include <fcntl.h>
#include <sys/eventfd.h>
#include <unistd.h>
#include <xf86drm.h>

extern "C" {
#include <libseat.h>
}

// A seat as our fake keeps it; the library's type is opaque.
struct libseat {
  const libseat_seat_listener* listener = nullptr;
  void* user = nullptr;
  int wake = -1;
  int next_id = 1;
  std::map<int, int> devices; // id → our own descriptor of the same open card
  std::deque<std::function<void(libseat&)>> news;
};

namespace octascope::tests {

namespace {

libseat* current = nullptr;

void tell(std::function<void(libseat&)> news) {
  if (current == nullptr)
    return;
  current->news.push_back(std::move(news));
  eventfd_write(current->wake, 1);
}

} // namespace

FakeSeat& fake_seat() {
  static FakeSeat seat;
  return seat;
}

void FakeSeat::switch_away() {
  in_front = false;
  acknowledged = false;
  if (current != nullptr)
    for (const auto& [id, descriptor] : current->devices)
      drmDropMaster(descriptor);
  tell([](libseat& seat) { seat.listener->disable_seat(&seat, seat.user); });
}

void FakeSeat::switch_back() {
  in_front = true;
  if (current != nullptr)
    for (const auto& [id, descriptor] : current->devices)
      drmSetMaster(descriptor);
  tell([](libseat& seat) { seat.listener->enable_seat(&seat, seat.user); });
}

} // namespace octascope::tests

using octascope::tests::current;
using octascope::tests::fake_seat;

extern "C" {

void libseat_set_log_level(libseat_log_level) {}

libseat* libseat_open_seat(const libseat_seat_listener* listener, void* user) {
  if (!fake_seat().answers) {
    errno = ENOENT;
    return nullptr;
  }
  current = new libseat{listener, user, eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK), 1, {}, {}};
  ++fake_seat().seats;
  if (fake_seat().in_front)
    octascope::tests::tell([](libseat& seat) { seat.listener->enable_seat(&seat, seat.user); });
  return current;
}

int libseat_close_seat(libseat* seat) {
  for (const auto& [id, descriptor] : seat->devices)
    close(descriptor);
  close(seat->wake);
  --fake_seat().seats;
  delete seat;
  current = nullptr;
  return 0;
}

int libseat_disable_seat(libseat*) {
  fake_seat().acknowledged = true;
  return 0;
}

int libseat_open_device(libseat* seat, const char* path, int* descriptor) {
  const int opened = open(path, O_RDWR | O_CLOEXEC | O_NONBLOCK);
  if (opened == -1)
    return -1;
  drmSetMaster(opened); // whether it is, the client finds out
  *descriptor = fcntl(opened, F_DUPFD_CLOEXEC, 0);
  seat->devices[seat->next_id] = opened;
  ++fake_seat().opened;
  return seat->next_id++;
}

int libseat_close_device(libseat* seat, int id) {
  const auto found = seat->devices.find(id);
  if (found == seat->devices.end()) {
    errno = ENOENT;
    return -1;
  }
  close(found->second);
  seat->devices.erase(found);
  --fake_seat().opened;
  return 0;
}

const char* libseat_seat_name(libseat*) {
  return "seat0";
}

int libseat_get_fd(libseat* seat) {
  return seat->wake;
}

int libseat_dispatch(libseat* seat, int) {
  eventfd_t ignored = 0;
  eventfd_read(seat->wake, &ignored);
  int handled = 0;
  for (; !seat->news.empty(); ++handled) {
    const auto news = seat->news.front();
    seat->news.pop_front();
    news(*seat);
  }
  return handled;
}

} // extern "C"
