#include "firmware-host/thread_roles.h"

#include <array>
#include <string>
#include <string_view>

#include "hal/linux/realtime.h"

namespace octascope::firmware_host {

namespace {

struct Role {
  std::string_view name;
  int priority; // SCHED_FIFO; 0: ordinary
};

constexpr std::array roles{
    Role{"camera", 42}, Role{"volumes", 41}, Role{"controls", 40},
    Role{"worker", 30}, Role{"scope", 0},
};

int priority_of(std::string_view name) {
  for (const Role& role : roles) {
    if (role.name == name)
      return role.priority;
  }
  return 0;
}

} // namespace

pipeline::ThreadSetup make_thread_setup(hal::Clock& clock, pipeline::FaultLog& faults) {
  return [&clock, &faults](std::string_view role) {
    hal::linux_backend::name_this_thread("octa-" + std::string{role});
    const int priority = priority_of(role);
    if (priority == 0)
      return;
    if (const auto made = hal::linux_backend::make_this_thread_realtime(priority); !made)
      faults.add("host", "no_realtime", made.error().message, clock.now());
  };
}

} // namespace octascope::firmware_host
