#include "hal/linux/gpio/pulse_timer.h"

#include <array>
#include <cerrno>
#include <cstdint>
#include <ctime>
#include <system_error>
#include <utility>

#include <poll.h>
#include <sys/eventfd.h>
#include <sys/timerfd.h>
#include <unistd.h>

#include "hal/linux/system/system_error.h"

namespace octascope::hal::linux_backend {

namespace {

constexpr std::string_view name = "galvo trigger";

// What a timer or an event counter has to say; 0 when it has nothing.
std::uint64_t drain(const FileDescriptor& file) {
  std::uint64_t count = 0;
  return ::read(file.get(), &count, sizeof count) == sizeof count ? count : 0;
}

} // namespace

Result<> PulseTimer::start(std::function<void()> end) {
  timer_ = FileDescriptor{::timerfd_create(CLOCK_MONOTONIC, TFD_CLOEXEC | TFD_NONBLOCK)};
  stopping_ = FileDescriptor{::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)};
  if (!timer_ || !stopping_)
    return system_failure(name, "making a timer", errno);
  try {
    thread_ = std::thread{[this, at_end = std::move(end)] { run(at_end); }};
  } catch (const std::system_error& error) {
    return system_failure(name, "starting a thread", error.code().value());
  }
  return {};
}

int PulseTimer::end_at(TimePoint time) noexcept {
  constexpr std::int64_t ns_per_s = 1'000'000'000;
  const std::int64_t ns = time.time_since_epoch().count();
  const itimerspec at{{}, {ns / ns_per_s, ns % ns_per_s}};
  return ::timerfd_settime(timer_.get(), TFD_TIMER_ABSTIME, &at, nullptr) == 0 ? 0 : errno;
}

void PulseTimer::run(const std::function<void()>& end) {
  while (true) {
    std::array<pollfd, 2> waiting{{{timer_.get(), POLLIN, 0}, {stopping_.get(), POLLIN, 0}}};
    if (::poll(waiting.data(), waiting.size(), -1) < 0 && errno != EINTR) {
      // Out of memory, for a moment: come back soon rather than never.
      std::this_thread::sleep_for(std::chrono::milliseconds{1});
      continue;
    }
    if ((waiting[1].revents & POLLIN) != 0)
      return;
    if (drain(timer_) > 0)
      end();
  }
}

void PulseTimer::stop() {
  if (thread_.joinable()) {
    ::eventfd_write(stopping_.get(), 1);
    thread_.join();
  }
  timer_.reset();
  stopping_.reset();
}

} // namespace octascope::hal::linux_backend
