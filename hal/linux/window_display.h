// A window under X11 or Wayland, for development and for desktops: SDL2 with a GLES 3 context.
#pragma once

#include <memory>

#include "hal/clock.h"
#include "hal/display.h"
#include "hal/linux/system/flip_pacing.h"

namespace octascope::hal::linux_backend {

// Frames are paced by vertical synchronisation, or by the injected clock if the window system
// completes flips immediately (virtual outputs).
class WindowDisplay final : public Display {
public:
  // The clock is borrowed, must outlive the display and must also be the control inputs' clock.
  explicit WindowDisplay(Clock& clock);
  ~WindowDisplay() override;

private:
  struct Window;

  std::string_view do_backend() const override { return "window"; }
  bool do_simulated() const override { return false; }
  // ErrorCode::absent: no X11 or Wayland display was found. ErrorCode::unsupported: it has no
  // GLES 3.
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
  bool server_gone_ = false;
};

} // namespace octascope::hal::linux_backend
