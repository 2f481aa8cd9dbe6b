// The display's twin: draws into memory, without a screen, a window system or a GPU.
//
// A surfaceless EGL context (any Mesa provides one) and a framebuffer of the requested size, bound
// as the draw target. Refreshes are ticks of the injected clock, so that frames are paced as on a
// monitor.
#pragma once

#include <atomic>
#include <memory>

#include "hal/clock.h"
#include "hal/display.h"

namespace octascope::sim {

class OffscreenDisplay final : public hal::Display {
public:
  // The clock is borrowed and must outlive the display.
  explicit OffscreenDisplay(hal::Clock& clock);
  ~OffscreenDisplay() override;

  // Simulates a pulled cable: present() fails with ErrorCode::disconnected, and open() with
  // ErrorCode::absent, until restore(). However short the loss, the context is lost with it.
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
  // ErrorCode::unsupported: no EGL here can draw GLES 3 without a window.
  // ErrorCode::invalid_argument: size or rate out of range.
  hal::Result<> do_open(const hal::DisplayConfig& config) override;
  int do_width() const override { return width_; }
  int do_height() const override { return height_; }
  hal::Duration do_refresh_period() const override { return refresh_period_; }
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
