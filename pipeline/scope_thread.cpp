#include "pipeline/scope_thread.h"

#include <algorithm>
#include <cstring>

#include <fmt/format.h>

namespace octascope::pipeline {

using namespace std::chrono_literals;

namespace {

constexpr hal::Duration frame_timeout = 50ms; // also how soon a stop is noticed

void copy_rows(const hal::ScopeFrame& frame, ScopePicture& picture) {
  const auto row_bytes = static_cast<std::size_t>(frame.width) * 3;
  const auto stride = static_cast<std::size_t>(frame.stride_bytes);
  for (std::size_t row = 0; row < static_cast<std::size_t>(frame.height); ++row)
    std::memcpy(&picture.rgb[row * row_bytes], &frame.pixels[row * stride], row_bytes);
}

} // namespace

ScopeThread::ScopeThread(hal::ScopeCamera& camera, const hal::ScopeCameraConfig& config,
                         hal::Clock& clock, FaultLog& faults)
    : camera_(camera), config_(config), clock_(clock), faults_(faults) {}

ScopeThread::~ScopeThread() { stop(); }

void ScopeThread::start(const ThreadSetup& setup) {
  thread_ = std::thread{[this, setup] {
    if (setup)
      setup("scope");
    run();
  }};
}

void ScopeThread::stop() {
  if (!thread_.joinable())
    return;
  stopping_.store(true, std::memory_order_release);
  thread_.join();
}

const ScopePicture* ScopeThread::take_newest() {
  const auto index = triple_buffer_.take();
  return index ? &pictures_[*index] : nullptr;
}

void ScopeThread::run() {
  while (!stopping_.load(std::memory_order_acquire)) {
    if (camera_.state() != hal::DeviceState::streaming && !open_and_start()) {
      clock_.sleep_for(frame_timeout);
      continue;
    }
    const auto frame = camera_.wait_frame(frame_timeout);
    if (!frame) {
      fault(frame.error());
      camera_.close();
    } else if (*frame) {
      if (receive(**frame))
        back_ = triple_buffer_.publish(back_).recycled;
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
  faults_.add("scope_camera", to_string(error.fault), error.message, clock_.now());
}

bool ScopeThread::receive(const hal::ScopeFrame& frame) {
  const auto row_bytes = static_cast<std::int64_t>(frame.width) * 3;
  const auto needed = static_cast<std::int64_t>(frame.stride_bytes) * (frame.height - 1) + row_bytes;
  if (frame.format != hal::PixelFormat::rgb8 || frame.stride_bytes < row_bytes ||
      static_cast<std::int64_t>(frame.pixels.size()) < needed) {
    fault({hal::Fault::bad_data,
           fmt::format("a picture of {}×{} pixels in {} bytes cannot be shown, expected RGB with 3 "
                       "bytes a pixel",
                       frame.width, frame.height, frame.pixels.size())});
    return false;
  }
  ScopePicture& picture = pictures_[back_];
  picture.width = frame.width;
  picture.height = frame.height;
  picture.rgb.resize(static_cast<std::size_t>(row_bytes) * static_cast<std::size_t>(frame.height));
  copy_rows(frame, picture);
  picture.sequence = frame.sequence;
  picture.time = frame.time;
  return true;
}

} // namespace octascope::pipeline
