// A window under X11 or Wayland, for development and for desktops: SDL2 with a GLES 3 context.
#pragma once

#include <memory>

#include "hal/clock.h"
#include "hal/display.h"
#include "hal/linux/system/flip_pacing.h"

namespace octascope::hal::linux_backend {

// Vertical synchronisation paces the frames where the window system has it; where flips complete at
// once (virtual outputs), the injected clock does.
class WindowDisplay final : public Display {
public:
  // The clock is borrowed, must outlive the display and be the one of the control inputs.
  explicit WindowDisplay(Clock& clock);
  ~WindowDisplay() override;

private:
  struct Window;

  std::string_view do_backend() const override { return "window"; }
  bool do_simulated() const override { return false; }
  // ErrorCode::absent: no X11 or Wayland display to be found. ErrorCode::unsupported: no GLES 3
  // there.
  Result<> do_open(const DisplayConfig& config) override;
  int do_width() const override;
  int do_height() const override;
  Duration do_refresh_period() const override { return refresh_period_; }
  Result<Flip> do_present() override;
  std::size_t do_poll_events(std::span<DisplayEvent> events) override;
  void do_close() override;

  Clock& clock_;
  std::unique_ptr<Window> window_;
  Duration refresh_period_{};
  FlipPacer pacer_;
  std::uint64_t flips_ = 0;
};

} // namespace octascope::hal::linux_backend
