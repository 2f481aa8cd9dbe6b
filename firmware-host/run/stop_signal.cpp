#include "firmware-host/run/stop_signal.h"

#include <csignal>

#include <sys/signalfd.h>
#include <unistd.h>

namespace octascope::firmware_host {

namespace {

sigset_t stop_signals() {
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGINT);
  sigaddset(&set, SIGTERM);
  return set;
}

} // namespace

StopSignal::StopSignal() {
  const sigset_t set = stop_signals();
  pthread_sigmask(SIG_BLOCK, &set, nullptr);
  descriptor_ = signalfd(-1, &set, SFD_NONBLOCK | SFD_CLOEXEC);
}

StopSignal::~StopSignal() {
  if (descriptor_ >= 0)
    close(descriptor_);
}

bool StopSignal::requested() {
  signalfd_siginfo info{};
  if (!requested_ && read(descriptor_, &info, sizeof info) == sizeof info) {
    requested_ = true;
    const sigset_t set = stop_signals();
    pthread_sigmask(SIG_UNBLOCK, &set, nullptr);
  }
  return requested_;
}

} // namespace octascope::firmware_host
