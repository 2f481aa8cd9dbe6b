#include "tests/soak/cpu_hog.h"

#include <random>

#include <pthread.h>
#include <sched.h>

#include "hal/linux/realtime.h"

namespace octascope::tests {
namespace {

using Clock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

// Beyond what hal::linux_backend lets the program have.
bool come_before_all_others() {
  const sched_param highest{.sched_priority = sched_get_priority_max(SCHED_FIFO)};
  return pthread_setschedparam(pthread_self(), SCHED_FIFO, &highest) == 0;
}

// Every processor's thread draws the same times.
void steal(const std::stop_token& end, Clock::time_point begin, Seconds each, unsigned seed) {
  std::mt19937 random{seed};
  std::uniform_real_distribution<double> wait_s{0.5, 1.5};
  Seconds next{0};
  while (true) {
    next += Seconds{wait_s(random)};
    const auto at = begin + std::chrono::duration_cast<Clock::duration>(next);
    std::this_thread::sleep_until(at);
    if (end.stop_requested())
      return;
    while (Clock::now() - at < each) {
    }
  }
}

} // namespace

CpuHog::CpuHog(Seconds each, unsigned seed) {
  const Clock::time_point begin = Clock::now();
  for (const int core : hal::linux_backend::allowed_cores())
    threads_.emplace_back([=](const std::stop_token& end) {
      if (hal::linux_backend::pin_this_thread(core) && come_before_all_others())
        steal(end, begin, each, seed);
    });
}

bool CpuHog::is_permitted() {
  bool permitted = false;
  std::jthread{[&] { permitted = come_before_all_others(); }}.join();
  return permitted;
}

} // namespace octascope::tests
