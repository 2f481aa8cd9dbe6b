// A monitor on the console, without a window system: kernel mode setting (libdrm) shows what EGL
// has drawn into GBM buffers.
//
// output_choice.h chooses the output (by default the first monitor, in its preferred mode). Images
// are shown with atomic commits if the driver has them; each present() waits for its flip; close()
// restores the console. Sources: docs.kernel.org/gpu/drm-kms.html, drm-uapi.html.
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
    managed,   // seatd or logind grants the card, and revokes it for another console
    plain,     // --no-seat: the card is opened directly; for root and for test benches
  };

  std::string connector; // "HDMI-A-1", "card1:HDMI-A-1"; empty: the first with a monitor
  std::string mode;      // "1920x1080@60" and more (mode_choice.h); empty: the preferred mode
  kms::Overscan overscan;
  SeatUse seat = SeatUse::automatic;
  bool atomic = true; // false: the legacy calls, for drivers whose atomic commits fail
};

// KmsConfig gives the mode: DisplayConfig is checked but otherwise ignored. poll_events() returns
// the events of `keys`, which has the keyboard focus while the display is open and its console in
// the foreground; without `keys` there are none.
//
// While another console is in the foreground, or another program has taken the card, present()
// shows nothing and returns after 100 ms with an unchanged sequence; the next image that is shown
// sets the mode again.
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
  // ErrorCode::absent: no monitor, no card. ErrorCode::denied: this user may not open the card.
  // ErrorCode::busy: another program uses it. ErrorCode::unsupported: no such mode, no GLES 3.
  Result<> do_open(const DisplayConfig& config) override;
  int do_width() const override;
  int do_height() const override;
  Duration do_refresh_period() const override { return refresh_period_; }
  std::optional<TimePoint> do_next_refresh() const override { return pacer_.next_refresh(); }
  BackBuffer do_back_buffer() override;
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
