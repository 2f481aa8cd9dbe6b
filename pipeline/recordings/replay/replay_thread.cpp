#include "pipeline/recordings/replay/replay_thread.h"

#include <utility>

#include "pipeline/threads/heartbeat.h"

namespace octascope::pipeline {

ReplayThread::ReplayThread(ReplaySource source, const ReplaySetup& setup, hal::Clock& clock,
                           FaultLog& faults, Wakeup& news)
    : clock_{clock}, player_{std::move(source), setup, faults, news} {}

ReplayThread::~ReplayThread() {
  stop();
}

void ReplayThread::start(const ThreadSetup& setup) {
  thread_ = std::thread{[this, setup] {
    if (setup)
      setup({"replay"});
    run();
  }};
}

void ReplayThread::stop() {
  if (!thread_.joinable())
    return;
  stopping_.store(true, std::memory_order_release);
  wakeup_.post();
  thread_.join();
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
  while (!stopping_.load(std::memory_order_acquire)) {
    const hal::TimePoint now = clock_.now();
    Heartbeat::beat_here(now);
    wakeup_.wait_until(clock_, player_.step(now));
  }
  Heartbeat::rest_here();
}

} // namespace octascope::pipeline
