#include "pipeline/controls/scope_thread.h"

#include "pipeline/threads/heartbeat.h"

namespace octascope::pipeline {

using namespace std::chrono_literals;

namespace {

constexpr hal::Duration frame_timeout = 50ms; // also how soon a stop is noticed

} // namespace

ScopeThread::ScopeThread(hal::ScopeCamera& camera, const hal::ScopeCameraConfig& config,
                         hal::Clock& clock, FaultLog& faults, Wakeup& news)
    : camera_(camera), config_(config), clock_(clock), faults_(faults), news_(news) {}

void ScopeThread::start(const ThreadSetup& setup) {
  thread_.start({"scope"}, setup, [this] { run(); });
}

const hal::ScopeFrame* ScopeThread::take_newest() {
  const auto index = triple_buffer_.take();
  return index ? &pictures_[*index].frame : nullptr;
}

void ScopeThread::run() {
  while (!thread_.stopping()) {
    Heartbeat::beat_here(clock_.now());
    if (camera_.state() != hal::DeviceState::streaming && !open_and_start()) {
      clock_.sleep_for(frame_timeout);
      continue;
    }
    const auto frame = camera_.wait_frame(frame_timeout);
    if (!frame) {
      fault(frame.error());
      camera_.close();
    } else if (*frame) {
      receive(**frame);
      camera_.release((*frame)->buffer);
    }
  }
  camera_.stop();
  camera_.close();
}

bool ScopeThread::open_and_start() {
  if (!retry_.due(clock_.now()))
    return false;
  const auto result = camera_.open(config_).and_then([&] { return camera_.start(); });
  if (!result) {
    fault(result.error());
    camera_.close();
    retry_.failure(clock_.now());
    return false;
  }
  retry_.success();
  return true;
}

void ScopeThread::fault(const hal::Error& error) {
  faults_.add(Device::scope_camera, error, clock_.now());
}

void ScopeThread::receive(const hal::ScopeFrame& frame) {
  Picture& picture = pictures_[back_];
  picture.bytes.assign(frame.pixels.begin(), frame.pixels.end());
  picture.frame = frame;
  picture.frame.pixels = picture.bytes;
  back_ = triple_buffer_.publish(back_).recycled;
  news_.post();
}

} // namespace octascope::pipeline
