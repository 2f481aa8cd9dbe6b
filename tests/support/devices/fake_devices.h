// A line camera and a trigger whose strings the test holds: frames come when, and as, it says.
//
// The twins in sim/ behave like devices; these behave like nothing, so that a test of the pipeline
// can put any frame at any time.
#pragma once

#include <condition_variable>
#include <deque>
#include <mutex>
#include <optional>
#include <set>
#include <vector>

#include "hal/galvo_trigger.h"
#include "hal/line_camera.h"

namespace octascope::tests {

class FakeCamera final : public hal::LineCamera {
public:
  // Delivers a frame in which every byte is `fill`.
  void deliver(std::uint64_t sequence, hal::TimePoint first_line, std::uint8_t fill,
               hal::FrameIntegrity integrity = hal::FrameIntegrity::good) {
    const std::lock_guard lock{mutex_};
    queue_.push_back({sequence, first_line, fill, integrity});
    changed_.notify_one();
  }
  // Whoever waits for a frame waits until let_go(), like a thread that gets no processor.
  void hold() {
    const std::lock_guard lock{mutex_};
    hold_ = true;
  }
  // Until somebody does.
  void wait_until_held() {
    std::unique_lock lock{mutex_};
    held_changed_.wait(lock, [this] { return held_; });
  }
  void let_go() {
    const std::lock_guard lock{mutex_};
    hold_ = false;
    held_changed_.notify_all();
  }
  void unplug() {
    const std::lock_guard lock{mutex_};
    plugged_ = false;
    changed_.notify_one();
  }
  void replug() {
    const std::lock_guard lock{mutex_};
    plugged_ = true;
  }
  // Of those that are delivered from now on.
  void time_by_host(bool by_host) {
    const std::lock_guard lock{mutex_};
    timed_by_host_ = by_host;
  }
  // So many calls of start() find that it has not answered yet.
  void start_late(int calls) {
    const std::lock_guard lock{mutex_};
    late_starts_ = calls;
  }
  // As drivers do, from the next open() on.
  void give_fewer_buffers(int buffers) {
    const std::lock_guard lock{mutex_};
    fewer_buffers_ = buffers;
  }
  std::size_t on_loan() const {
    const std::lock_guard lock{mutex_};
    return loans_.size();
  }
  int opened() const {
    const std::lock_guard lock{mutex_};
    return opened_;
  }

private:
  struct Order {
    std::uint64_t sequence;
    hal::TimePoint first_line;
    std::uint8_t fill;
    hal::FrameIntegrity integrity;
  };

  std::string_view do_backend() const override { return "fake"; }
  bool do_simulated() const override { return true; }
  std::string do_identity() const override { return {}; }
  hal::Result<> do_open(const hal::LineCameraConfig& config) override {
    const std::lock_guard lock{mutex_};
    if (!plugged_)
      return hal::fail(hal::ErrorCode::absent, "the fake is unplugged");
    config_ = config;
    config_.buffers = fewer_buffers_.value_or(config.buffers);
    memory_.assign(static_cast<std::size_t>(config_.buffers),
                   std::vector<std::byte>(config.format.frame_bytes()));
    ++opened_;
    set_state(hal::DeviceState::ready);
    return {};
  }
  std::optional<int> do_fewer_buffers() const override {
    const std::lock_guard lock{mutex_};
    return fewer_buffers_;
  }
  hal::Result<> do_start() override {
    const std::lock_guard lock{mutex_};
    if (late_starts_ > 0) {
      --late_starts_;
      return hal::fail(hal::ErrorCode::absent, "the fake has not answered yet");
    }
    set_state(hal::DeviceState::streaming);
    return {};
  }
  hal::Result<std::optional<hal::LineFrame>> do_wait_frame(hal::Duration timeout) override {
    std::unique_lock lock{mutex_};
    changed_.wait_for(lock, timeout, [this] { return !queue_.empty() || !plugged_; });
    if (hold_) {
      held_ = true;
      held_changed_.notify_all();
      held_changed_.wait(lock, [this] { return !hold_; });
      held_ = false;
    }
    if (!plugged_) {
      queue_.clear();
      set_state(hal::DeviceState::failed);
      return hal::fail(hal::ErrorCode::disconnected, "the fake was unplugged");
    }
    if (queue_.empty())
      return std::nullopt;
    const Order order = queue_.front();
    int buffer = 0;
    while (loans_.contains(buffer))
      ++buffer;
    if (buffer == config_.buffers)
      return std::nullopt;
    queue_.pop_front();
    loans_.insert(buffer);
    auto& bytes = memory_[static_cast<std::size_t>(buffer)];
    std::fill(bytes.begin(), bytes.end(), std::byte{order.fill});
    return hal::LineFrame{buffer,
                          bytes,
                          order.sequence,
                          order.first_line,
                          order.first_line + std::chrono::microseconds{100},
                          order.integrity,
                          timed_by_host_};
  }
  void do_release(int buffer) override {
    const std::lock_guard lock{mutex_};
    loans_.erase(buffer);
  }
  void do_stop() override {
    if (state() == hal::DeviceState::streaming)
      set_state(hal::DeviceState::ready);
  }
  void do_close() override { set_state(hal::DeviceState::absent); }

  mutable std::mutex mutex_;
  std::condition_variable changed_, held_changed_;
  std::deque<Order> queue_;
  std::set<int> loans_;
  std::vector<std::vector<std::byte>> memory_;
  std::optional<int> fewer_buffers_;
  hal::LineCameraConfig config_;
  int late_starts_ = 0;
  bool timed_by_host_ = false;
  int opened_ = 0;
  bool plugged_ = true;
  bool hold_ = false, held_ = false;
};

class FakeTrigger final : public hal::GalvoTrigger {
public:
  explicit FakeTrigger(hal::Clock& clock) : clock_(clock) {}

  // Waits for the pulse with this number, counting from 0.
  hal::TimePoint wait_for_pulse(std::size_t number) {
    std::unique_lock lock{mutex_};
    changed_.wait(lock, [&] { return pulses_.size() > number; });
    return pulses_[number];
  }
  std::size_t pulses() const {
    const std::lock_guard lock{mutex_};
    return pulses_.size();
  }

private:
  std::string_view do_backend() const override { return "fake"; }
  bool do_simulated() const override { return true; }
  hal::Result<> do_open(const hal::GalvoTriggerConfig&) override {
    set_state(hal::DeviceState::ready);
    return {};
  }
  hal::Result<hal::TimePoint> do_pulse() override {
    const std::lock_guard lock{mutex_};
    pulses_.push_back(clock_.now());
    changed_.notify_one();
    return pulses_.back();
  }
  void do_close() override { set_state(hal::DeviceState::absent); }

  hal::Clock& clock_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<hal::TimePoint> pulses_;
};

} // namespace octascope::tests
