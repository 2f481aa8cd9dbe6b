#include "firmware-host/run/stop_signal.h"

#include <sys/signalfd.h>
#include <unistd.h>

namespace octascope::firmware_host {

StopSignal::StopSignal(HangUp hang_up) {
  sigemptyset(&signals_);
  sigaddset(&signals_, SIGINT);
  sigaddset(&signals_, SIGTERM);
  if (hang_up == HangUp::ends)
    sigaddset(&signals_, SIGHUP);
  pthread_sigmask(SIG_BLOCK, &signals_, nullptr);
  descriptor_ = signalfd(-1, &signals_, SFD_NONBLOCK | SFD_CLOEXEC);
}

StopSignal::~StopSignal() {
  if (descriptor_ >= 0)
    close(descriptor_);
}

bool StopSignal::requested() {
  signalfd_siginfo info{};
  if (!requested_ && read(descriptor_, &info, sizeof info) == sizeof info) {
    requested_ = true;
    pthread_sigmask(SIG_UNBLOCK, &signals_, nullptr);
  }
  return requested_;
}

} // namespace octascope::firmware_host
