#include "firmware-host/supervision/thread_watch.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "hal/linux/realtime.h"

namespace octascope::firmware_host {

namespace {

using namespace std::chrono_literals;
using pipeline::Fault;

struct WatchedRole {
  std::string_view name;
  Fault when_stuck;
  // Far more than a step ever takes: 50 ms of waiting for most, one B-scan for a worker. Opening a
  // device is a step, too, and some drivers and libcamera take seconds for it.
  hal::Duration limit;
  bool waits_in_each_step = true; // workers may have much to do
};

constexpr std::array watched_roles{
    WatchedRole{"camera", Fault::line_camera_stuck_thread, 5s},
    WatchedRole{"volumes", Fault::pipeline_stuck_thread, 3s},
    WatchedRole{"worker", Fault::pipeline_stuck_thread, 3s, false},
    WatchedRole{"controls", Fault::control_input_stuck_thread, 5s},
    WatchedRole{"scope", Fault::scope_camera_stuck_thread, 10s},
    WatchedRole{"phase", Fault::pipeline_stuck_thread, 10s},
};

} // namespace

void ThreadWatch::enlist(const pipeline::ThreadRole& role, hal::TimePoint now) {
  const auto* const known = std::ranges::find(watched_roles, role.name, &WatchedRole::name);
  if (known == watched_roles.end())
    return;
  const std::lock_guard lock{mutex_};
  Watched& watched = threads_.emplace_back();
  watched.name =
      role.name == "worker" ? fmt::format("{} {}", role.name, role.number) : std::string{role.name};
  watched.when_stuck = known->when_stuck;
  watched.limit = known->limit;
  watched.heartbeat.beat(now);
  pipeline::Heartbeat::give_this_thread(&watched.heartbeat);
  if (known->waits_in_each_step)
    hal::linux_backend::expect_waits(watched.demoted);
}

std::vector<ThreadState> ThreadWatch::states(hal::TimePoint now) const {
  std::vector<ThreadState> states;
  const std::lock_guard lock{mutex_};
  for (const Watched& watched : threads_) {
    const auto last = watched.heartbeat.last();
    const hal::Duration silence = last ? std::max(now - *last, hal::Duration{}) : hal::Duration{};
    states.push_back({watched.name, silence > watched.limit, silence});
  }
  return states;
}

void ThreadWatch::complain(pipeline::FaultLog& faults, hal::TimePoint now) {
  const std::lock_guard lock{mutex_};
  for (Watched& watched : threads_) {
    if (watched.demoted.exchange(false))
      faults.add(pipeline::Fault::ran_away,
                 fmt::format("the thread \"{}\" computed for {} s without waiting, expected a wait "
                             "in each step: it has real-time priority no longer, so that "
                             "everything else goes on; start the program again",
                             watched.name, hal::to_seconds(longest_without_wait)),
                 now);
    const auto last = watched.heartbeat.last();
    if (last && now - *last > watched.limit)
      faults.add(watched.when_stuck,
                 fmt::format("the thread \"{}\" has made no step for {:.0f} s, expected one within "
                             "{:.0f} s: its driver or device hangs; unplug and replug the device, "
                             "or restart the program",
                             watched.name, hal::to_seconds(now - *last),
                             hal::to_seconds(watched.limit)),
                 now);
  }
}

} // namespace octascope::firmware_host
