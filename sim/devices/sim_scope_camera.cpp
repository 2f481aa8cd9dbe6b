#include "sim/devices/sim_scope_camera.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace octascope::sim {
namespace {

constexpr double pictures_per_s = 30;
constexpr double most_pictures = 300; // of a loop
constexpr double most_frames_per_s = 240;
constexpr int largest_side = 4096;

hal::Result<> check_size(std::string_view whose, int width, int height) {
  if (width < 16 || height < 16 || width > largest_side || height > largest_side)
    return hal::fail(hal::ErrorCode::invalid_argument,
                     "scope camera: {} is {}×{}, expected 16×16 to {}×{}", whose, width, height,
                     largest_side, largest_side);
  return {};
}

} // namespace

hal::Result<std::unique_ptr<SimScopeCamera>>
SimScopeCamera::make(const SimScopeCameraOptions& options, hal::Clock& clock) {
  HAL_CHECK(check_size("the twin's picture", options.width, options.height));
  if (options.loop <= hal::Duration::zero())
    return hal::fail(hal::ErrorCode::invalid_argument,
                     "scope camera: the loop lasts {} s, expected more than 0",
                     hal::to_seconds(options.loop));
  HAL_TRY(auto phantom, make_phantom(options.phantom, options.seed));
  return std::unique_ptr<SimScopeCamera>(new SimScopeCamera(options, clock, std::move(phantom)));
}

SimScopeCamera::SimScopeCamera(const SimScopeCameraOptions& options, hal::Clock& clock,
                               std::unique_ptr<const Phantom> phantom)
    : clock_(clock), width_(options.width), height_(options.height), loop_(options.loop),
      phantom_(std::move(phantom)), picture_(*phantom_, width_, height_),
      scan_field_(picture_.field(options.field.a_mm(), options.field.b_mm())) {
  const double wanted =
      phantom_->instrument() != nullptr ? pictures_per_s * hal::to_seconds(loop_) : 1;
  pictures_.resize(static_cast<std::size_t>(std::clamp(wanted, 1.0, most_pictures) + 0.5));
  for (std::vector<std::uint8_t>& pixels : pictures_)
    pixels.reserve(picture_.bytes());
}

hal::Result<> SimScopeCamera::check_cable() {
  if (plugged_.load(std::memory_order_acquire))
    return {};
  set_state(hal::DeviceState::failed);
  forget_loans();
  return hal::fail(hal::ErrorCode::disconnected,
                   "scope camera: found unplugged, expected it to stream; close it, plug it in "
                   "and open it again");
}

hal::Result<> SimScopeCamera::do_open(const hal::ScopeCameraConfig& config) {
  HAL_CHECK(check_size("the wanted", config.width, config.height));
  if (!(config.frames_per_s > 0 && config.frames_per_s <= most_frames_per_s))
    return hal::fail(hal::ErrorCode::invalid_argument,
                     "scope camera: {} frames/s are asked for, expected more than 0 to {}",
                     config.frames_per_s, most_frames_per_s);
  if (!plugged_.load(std::memory_order_acquire))
    return hal::fail(hal::ErrorCode::absent,
                     "scope camera: found none, expected one; plug it in and try again");
  period_ = hal::from_seconds(1 / config.frames_per_s);
  set_state(hal::DeviceState::ready);
  return {};
}

hal::Result<> SimScopeCamera::do_start() {
  HAL_CHECK(check_cable());
  started_ = clock_.now();
  next_ = 0;
  set_state(hal::DeviceState::streaming);
  return {};
}

hal::Result<std::optional<hal::ScopeFrame>> SimScopeCamera::do_wait_frame(hal::Duration timeout) {
  const hal::TimePoint deadline = clock_.now() + timeout;
  for (;;) {
    HAL_CHECK(check_cable());
    // A frame is there once it was exposed, at the end of its period.
    const std::int64_t newest = (clock_.now() - started_) / period_ - 1;
    if (newest >= next_) {
      next_ = newest + 1;
      if (const int buffer = borrow_buffer(); buffer >= 0)
        return frame(newest, buffer);
    }
    const hal::TimePoint due = started_ + period_ * (next_ + 1);
    if (due > deadline) {
      clock_.sleep_until(deadline);
      HAL_CHECK(check_cable());
      return std::nullopt;
    }
    clock_.sleep_until(due);
  }
}

std::span<const std::uint8_t> SimScopeCamera::pixels_at(double phase) {
  const auto count = static_cast<double>(pictures_.size());
  const auto index = std::min(static_cast<std::size_t>(phase * count), pictures_.size() - 1);
  std::vector<std::uint8_t>& pixels = pictures_[index];
  if (pixels.empty()) {
    pixels.resize(picture_.bytes());
    picture_.draw(static_cast<double>(index) / count, pixels);
  }
  return pixels;
}

hal::ScopeFrame SimScopeCamera::frame(std::int64_t number, int buffer) {
  hal::ScopeFrame frame;
  frame.buffer = buffer;
  frame.width = width_;
  frame.height = height_;
  frame.stride_bytes = width_ * 3;
  frame.format = hal::PixelFormat::rgb8;
  frame.sequence = static_cast<std::uint64_t>(number);
  frame.time = started_ + period_ * (number + 1);
  const double phase =
      hal::to_seconds(frame.time.time_since_epoch() % loop_) / hal::to_seconds(loop_);
  frame.pixels = std::as_bytes(pixels_at(phase));
  return frame;
}

int SimScopeCamera::borrow_buffer() {
  for (std::size_t i = 0; i < on_loan_.size(); ++i)
    if (!on_loan_[i].exchange(true, std::memory_order_acquire))
      return static_cast<int>(i);
  return -1;
}

void SimScopeCamera::do_release(int buffer) {
  if (buffer >= 0 && static_cast<std::size_t>(buffer) < on_loan_.size())
    on_loan_[static_cast<std::size_t>(buffer)].store(false, std::memory_order_release);
}

void SimScopeCamera::forget_loans() {
  for (std::atomic<bool>& loan : on_loan_)
    loan.store(false, std::memory_order_release);
}

void SimScopeCamera::do_stop() {
  if (state() == hal::DeviceState::streaming)
    set_state(hal::DeviceState::ready);
}

void SimScopeCamera::do_close() {
  forget_loans();
  set_state(hal::DeviceState::absent);
}

} // namespace octascope::sim
