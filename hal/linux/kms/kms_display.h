// A monitor on the bare console, without a window system: kernel mode setting (libdrm) shows what
// EGL has drawn into GBM buffers.
//
// The output is chosen by output_choice.h (first monitor, its preferred mode), pictures are shown
// by atomic commits where the driver has them, each present() waits for its flip, and what the
// console showed before comes back at close(). Sources: docs.kernel.org/gpu/drm-kms.html,
// drm-uapi.html.
#pragma once

#include <memory>
#include <string>

#include "hal/clock.h"
#include "hal/display.h"
#include "hal/key_source.h"
#include "hal/linux/kms/mode/overscan.h"
#include "hal/linux/system/flip_pacing.h"

namespace octascope::hal::linux_backend {

struct KmsConfig {
  enum class SeatUse {
    automatic, // managed, else plain
    managed,   // seatd or logind grant the card, and pause us when another console is in front
    plain,     // --no-seat: the card is opened and taken; for root and for test benches
  };

  std::string connector; // "HDMI-A-1", "card1:HDMI-A-1"; empty: the first with a monitor
  std::string mode;      // "1920x1080@60" and more (mode_choice.h); empty: what the monitor prefers
  kms::Overscan overscan;
  SeatUse seat = SeatUse::automatic;
  bool atomic = true; // false: the older calls, for drivers whose atomic ones fail
};

// The mode is KmsConfig's: width, height, refresh_hz, fullscreen and title of DisplayConfig are
// checked but have no meaning here. poll_events() tells what `keys` tells, which is listened to
// while the display is open and its console in front; without one it tells nothing.
//
// While another console is in front, or another program has taken the card, present() shows nothing
// and returns after 100 ms a Flip whose sequence has not moved; the first picture after that comes
// with the mode.
class KmsDisplay final : public Display {
public:
  // The clock is borrowed and must outlive the display.
  KmsDisplay(Clock& clock, KmsConfig config, std::unique_ptr<KeySource> keys = nullptr);
  ~KmsDisplay() override;

  // "/dev/dri/card0 HDMI-A-1 (DELL U2415), 1920x1080@60.00, atomic"; empty while absent.
  const std::string& description() const { return description_; }

private:
  struct Session;

  std::string_view do_backend() const override { return "kms"; }
  bool do_simulated() const override { return false; }
  // ErrorCode::absent: no monitor, no card. ErrorCode::denied: the card must not be opened.
  // ErrorCode::busy: another program shows on it. ErrorCode::unsupported: no such mode, no GLES 3.
  Result<> do_open(const DisplayConfig& config) override;
  int do_width() const override;
  int do_height() const override;
  Duration do_refresh_period() const override { return refresh_period_; }
  Result<Flip> do_present() override;
  std::size_t do_poll_events(std::span<DisplayEvent> events) override {
    return keys_ ? keys_->poll_events(events) : 0;
  }
  void do_close() override;

  Result<Flip> lose(const Error& error);
  void attend(bool ours);

  Clock& clock_;
  const KmsConfig config_;
  const std::unique_ptr<KeySource> keys_;
  std::unique_ptr<Session> session_;
  std::string description_;
  Duration refresh_period_{};
  FlipPacer pacer_;
  std::uint64_t flips_ = 0;
};

} // namespace octascope::hal::linux_backend
