#include "pipeline/recordings/replay/replay_thread.h"

#include <utility>

#include "pipeline/threads/heartbeat.h"

namespace octascope::pipeline {

ReplayThread::ReplayThread(ReplaySource source, const ReplaySetup& setup, hal::Clock& clock,
                           FaultLog& faults, Wakeup& news)
    : clock_{clock}, player_{std::move(source), setup, faults, news} {}

void ReplayThread::start(const ThreadSetup& setup) {
  thread_.start({"replay"}, setup, [this] { run(); });
}

void ReplayThread::seek(std::size_t n) {
  player_.seek(n);
  wakeup_.post();
}

void ReplayThread::hold(bool held) {
  player_.hold(held);
  wakeup_.post();
}

void ReplayThread::run() {
  while (!thread_.stopping()) {
    const hal::TimePoint now = clock_.now();
    Heartbeat::beat_here(now);
    wakeup_.wait_until(clock_, player_.step(now));
  }
}

} // namespace octascope::pipeline
