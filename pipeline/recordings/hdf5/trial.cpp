#include "pipeline/recordings/hdf5/trial.h"

#include <cerrno>
#include <csignal>
#include <cstring>

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace octascope::pipeline {

namespace {

constexpr unsigned most_s = 30;

// Whoever watches over this program's crashes has nothing to report of this one.
void forget_signal_handlers() {
  for (const int number : {SIGSEGV, SIGBUS, SIGABRT, SIGFPE, SIGILL, SIGALRM})
    std::signal(number, SIG_DFL);
  sigset_t all;
  sigfillset(&all);
  sigprocmask(SIG_UNBLOCK, &all, nullptr);
  const rlimit no_core{0, 0};
  ::setrlimit(RLIMIT_CORE, &no_core);
}

} // namespace

hal::Result<> try_apart(const std::function<void()>& action) {
  const pid_t child = ::fork();
  if (child < 0)
    return hal::fail(hal::ErrorCode::system, "cannot be tried in a process of its own: {}",
                     std::strerror(errno));
  if (child == 0) {
    forget_signal_handlers();
    ::alarm(most_s);
    try {
      action();
    } catch (...) { // as without memory: nothing of this process may go on in the parent's frames
      ::_exit(1);
    }
    ::_exit(0);
  }
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0)
    return {};
  return hal::fail(hal::ErrorCode::bad_data, "is damaged: HDF5 {} it; take another copy of it",
                   WIFSIGNALED(status) && WTERMSIG(status) == SIGALRM ? "comes to no end with"
                                                                      : "crashes on");
}

} // namespace octascope::pipeline
