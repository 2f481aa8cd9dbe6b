#include "hal/linux/realtime.h"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <string>
#include <system_error>

#include <malloc.h>
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

ErrorCode error_code_of(int error) {
  return error == EPERM || error == EACCES ? ErrorCode::denied : ErrorCode::system;
}

thread_local constinit std::atomic<bool>* demoted_here = nullptr;

// Runs in the thread that did not wait.
void demote_this_thread(int /*signal*/) {
  if (demoted_here == nullptr)
    return;
  const int error = errno;
  const sched_param ordinary{};
  if (::sched_setscheduler(0, SCHED_OTHER, &ordinary) == 0)
    demoted_here->store(true, std::memory_order_relaxed);
  errno = error;
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
  return fail(error_code_of(error), "no real-time priority (" + system_message(error) +
                                        "): ticks may jitter; allow it with LimitRTPRIO=49 in the "
                                        "service unit, or \"@video - rtprio 49\" in limits.conf");
}

Result<> demote_runaways(Duration limit) {
  struct sigaction action {};
  action.sa_handler = demote_this_thread;
  action.sa_flags = SA_RESTART;
  rlimit allowed{};
  bool set =
      ::sigaction(SIGXCPU, &action, nullptr) == 0 && ::getrlimit(RLIMIT_RTTIME, &allowed) == 0;
  if (set) {
    const auto limit_us = std::chrono::duration_cast<std::chrono::microseconds>(limit).count();
    allowed.rlim_cur = std::min(static_cast<rlim_t>(limit_us), allowed.rlim_max);
    set = ::setrlimit(RLIMIT_RTTIME, &allowed) == 0;
  }
  if (set)
    return {};
  return fail(ErrorCode::system,
              "real-time threads that never wait would not be noticed ({}), expected a limit",
              system_message(errno));
}

void expect_waits(std::atomic<bool>& demoted) {
  demoted_here = &demoted;
}

std::vector<int> allowed_cores() {
  cpu_set_t set;
  CPU_ZERO(&set);
  std::vector<int> cores;
  if (sched_getaffinity(getpid(), sizeof(set), &set) != 0)
    return cores;
  for (int core = 0; core < CPU_SETSIZE; ++core) {
    if (CPU_ISSET(static_cast<std::size_t>(core), &set))
      cores.push_back(core);
  }
  return cores;
}

Result<> pin_this_thread(int core) {
  int error = EINVAL;
  if (core >= 0 && core < CPU_SETSIZE) {
    cpu_set_t set;
    CPU_ZERO(&set);
    CPU_SET(static_cast<std::size_t>(core), &set);
    error = pthread_setaffinity_np(pthread_self(), sizeof(set), &set);
  }
  if (error == 0)
    return {};
  std::string allowed;
  for (const int one : allowed_cores())
    allowed += (allowed.empty() ? "" : ", ") + std::to_string(one);
  return fail(error == EINVAL ? ErrorCode::invalid_argument : error_code_of(error),
              "a thread is not pinned to core " + std::to_string(core) + " (" +
                  system_message(error) + "): expected one of the allowed cores, " + allowed +
                  "; the system chooses instead");
}

void make_this_thread_background() {
  const sched_param none{};
  pthread_setschedparam(pthread_self(), SCHED_IDLE, &none);
}

Result<> lock_memory() {
  // On fault: what is never touched (stacks, the driver's reserves) is not fetched for its own
  // sake. The buffers of the hot paths are written when they are made, and so are in from then on.
  if (mlockall(MCL_CURRENT | MCL_FUTURE | MCL_ONFAULT) == 0)
    return {};
  const int error = errno;
  return fail(error_code_of(error == ENOMEM ? EPERM : error),
              "memory is not locked (" + system_message(error) +
                  "): a page fault may delay a volume; allow it with LimitMEMLOCK=infinity in the "
                  "service unit, or \"@video - memlock unlimited\" in limits.conf");
}

void keep_large_blocks_apart() {
  constexpr int mebibyte = 1 << 20;
  mallopt(M_MMAP_THRESHOLD, mebibyte);
  // The heap keeps what it has: to give it back and fetch it again is to wait for pages.
  mallopt(M_TRIM_THRESHOLD, 64 * mebibyte);
  mallopt(M_TOP_PAD, mebibyte);
}

} // namespace octascope::hal::linux_backend
