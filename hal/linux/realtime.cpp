#include "hal/linux/realtime.h"

#include <cerrno>
#include <string>
#include <system_error>

#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

namespace octascope::hal::linux_backend {

namespace {

std::string system_message(int error) {
  return std::generic_category().message(error);
}

Fault fault_of(int error) {
  return error == EPERM || error == EACCES ? Fault::denied : Fault::system;
}

} // namespace

void name_this_thread(std::string_view name) {
  constexpr std::size_t longest = 15; // the kernel's limit
  pthread_setname_np(pthread_self(), std::string{name.substr(0, longest)}.c_str());
}

Result<> make_this_thread_realtime(int priority) {
  sched_param parameters{};
  parameters.sched_priority = priority;
  const int error = pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters);
  if (error == 0)
    return {};
  return fail(fault_of(error), "no real-time priority (" + system_message(error) +
                                   "): ticks may jitter; allow it with LimitRTPRIO=49 in the "
                                   "service unit, or \"@video - rtprio 49\" in limits.conf");
}

void make_this_thread_background() {
  constexpr int lowest = 19;
  setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), lowest);
}

Result<> lock_memory() {
  // On fault: what is never touched (stacks, the driver's reserves) is not fetched for its own
  // sake. The buffers of the hot paths are written when they are made, and so are in from then on.
  if (mlockall(MCL_CURRENT | MCL_FUTURE | MCL_ONFAULT) == 0)
    return {};
  const int error = errno;
  return fail(fault_of(error == ENOMEM ? EPERM : error),
              "memory is not locked (" + system_message(error) +
                  "): a page fault may delay a volume; allow it with LimitMEMLOCK=infinity in the "
                  "service unit, or \"@video - memlock unlimited\" in limits.conf");
}

} // namespace octascope::hal::linux_backend
