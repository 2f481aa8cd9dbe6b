// A simulated display: draws into memory, without a screen, a window system or a GPU.
//
// Uses a surfaceless EGL context (included in every Mesa), with a framebuffer of the requested size
// as the draw target. Refreshes are ticks of the injected clock and pace frames like a screen.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>

#include "hal/clock.h"
#include "hal/display.h"

namespace octascope::sim {

// Whether so much memory suffices to draw a picture of that size on the processor, keep it and
// write it to a file. ErrorCode::invalid_argument if not.
hal::Result<> check_picture_memory(int width, int height, std::uint64_t available_bytes);

class OffscreenDisplay final : public hal::Display {
public:
  // The clock is borrowed and must outlive the display.
  explicit OffscreenDisplay(hal::Clock& clock);
  ~OffscreenDisplay() override;

  // Simulates a pulled display cable: until restore(), present() fails with ErrorCode::disconnected
  // and open() with ErrorCode::absent. However short the loss, the context is lost with it.
  // Thread-safe.
  void lose() {
    lost_.store(true, std::memory_order_release);
    context_lost_.store(true, std::memory_order_release);
  }
  void restore() { lost_.store(false, std::memory_order_release); }

private:
  struct Surface; // the EGL context and its framebuffer

  std::string_view do_backend() const override { return "offscreen"; }
  bool do_simulated() const override { return true; }
  // ErrorCode::unsupported: this machine has no EGL that can draw GLES 3 without a window.
  // ErrorCode::invalid_argument: invalid size or refresh rate, or too large a picture for this
  // machine's memory.
  hal::Result<> do_open(const hal::DisplayConfig& config) override;
  int do_width() const override { return width_; }
  int do_height() const override { return height_; }
  hal::Duration do_refresh_period() const override { return refresh_period_; }
  // There is one buffer only.
  hal::BackBuffer do_back_buffer() override { return {flips_ + 1, flips_}; }
  hal::Result<hal::Flip> do_present() override;
  std::size_t do_poll_events(std::span<hal::DisplayEvent>) override { return 0; }
  void do_close() override;

  hal::Clock& clock_;
  std::unique_ptr<Surface> surface_;
  int width_ = 0;
  int height_ = 0;
  hal::Duration refresh_period_{};
  hal::TimePoint opened_;
  std::uint64_t flips_ = 0;
  std::atomic<bool> lost_{false};
  std::atomic<bool> context_lost_{false}; // until the next open()
};

} // namespace octascope::sim
