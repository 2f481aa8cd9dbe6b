#include "firmware-host/supervision/thread_roles.h"

#include <array>
#include <string>
#include <string_view>

#include "firmware-host/crash/crash_report.h"
#include "hal/linux/realtime.h"

namespace octascope::firmware_host {

namespace {

struct Role {
  std::string_view name;
  int priority;            // SCHED_FIFO; 0: ordinary
  bool background = false; // ordinary, and after everything else
};

constexpr std::array roles{
    Role{"camera", 42},        Role{"volumes", 41},      Role{"controls", 40},
    Role{"worker", 30},        Role{"scope", 0},         Role{"phase", 0},
    Role{"rays", 0},           Role{"surface", 0, true}, Role{"tree", 0, true},
    Role{"follower", 0, true}, Role{"recorder", 0},      Role{"raw", 0},
    Role{"raw-sync", 0},
};

Role role_of(std::string_view name) {
  for (const Role& role : roles) {
    if (role.name == name)
      return role;
  }
  return {name, 0};
}

} // namespace

WorkerCores::WorkerCores(std::size_t workers, std::span<const int> configured,
                         std::span<const int> allowed)
    : pinned_(workers) {
  for (std::atomic<int>& core : pinned_)
    core.store(-1);
  const std::span<const int> cores = configured.empty() ? allowed : configured;
  if (cores.empty() || (configured.empty() && allowed.size() < workers))
    return;
  for (std::size_t worker = 0; worker < workers; ++worker)
    planned_.push_back(cores[worker % cores.size()]);
}

std::optional<int> WorkerCores::planned(std::size_t worker) const {
  return worker < planned_.size() ? std::optional{planned_[worker]} : std::nullopt;
}

void WorkerCores::set_pinned(std::size_t worker, int core) {
  pinned_.at(worker).store(core, std::memory_order_relaxed);
}

std::vector<int> WorkerCores::pinned() const {
  return {pinned_.begin(), pinned_.end()};
}

pipeline::ThreadSetup make_thread_setup(hal::Clock& clock, pipeline::FaultLog& faults,
                                        WorkerCores& cores, ThreadWatch* watch) {
  return [&clock, &faults, &cores, watch](pipeline::ThreadRole role) {
    CrashReport::prepare_this_thread();
    if (watch != nullptr)
      watch->enlist(role, clock.now());
    hal::linux_backend::name_this_thread("octa-" + std::string{role.name});
    if (const auto core = role.name == "worker" ? cores.planned(role.number) : std::nullopt) {
      if (const auto pinned = hal::linux_backend::pin_this_thread(*core); pinned)
        cores.set_pinned(role.number, *core);
      else
        faults.add(pipeline::Fault::not_pinned, pinned.error().message, clock.now());
    }
    const Role known = role_of(role.name);
    if (known.background)
      hal::linux_backend::make_this_thread_background();
    if (known.priority == 0)
      return;
    if (const auto made = hal::linux_backend::make_this_thread_realtime(known.priority); !made)
      faults.add(pipeline::Fault::no_realtime, made.error().message, clock.now());
    static_cast<void>(hal::linux_backend::demote_runaways(longest_without_wait));
  };
}

} // namespace octascope::firmware_host
