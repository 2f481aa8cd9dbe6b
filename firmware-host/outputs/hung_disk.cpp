#include "firmware-host/outputs/hung_disk.h"

#include <atomic>
#include <chrono>
#include <cstdio>
#include <memory>
#include <thread>
#include <utility>

#include <fmt/format.h>
#include <unistd.h>

namespace octascope::firmware_host {

using namespace std::chrono_literals;

bool ends_in_time(std::function<void()> end, const std::function<std::uint64_t()>& progress,
                  hal::Duration patience, hal::Clock& clock) {
  const auto ended = std::make_shared<std::atomic<bool>>(false); // the thread may outlive this call
  std::thread ending{[end = std::move(end), ended] {
    end();
    *ended = true;
  }};
  std::uint64_t before = progress();
  hal::TimePoint progressed = clock.now();
  while (!*ended) {
    clock.sleep_for(2ms);
    if (const std::uint64_t now = progress(); std::exchange(before, now) != now)
      progressed = clock.now();
    if (clock.now() - progressed > patience && !*ended) {
      ending.detach();
      return false;
    }
  }
  ending.join();
  return true;
}

hal::Error hung_disk(const std::string& file, const std::string& kept, hal::Duration patience) {
  return {
      hal::ErrorCode::timed_out,
      fmt::format("{}: its disk has not answered for {:g} s, and is no longer waited for: the "
                  "recording is not finished; {} were handed to the disk, of which the last may "
                  "be lost, and those that still waited are. Look at the disk, then whether "
                  "octascope info reads the file",
                  file, hal::to_seconds(patience), kept)};
}

void leave_at_once(int exit_status) {
  std::fflush(stdout);
  std::fflush(stderr);
  ::_exit(exit_status); // no destructor and no library: they would wait for the disk
}

} // namespace octascope::firmware_host
