// One output in use: shows images on it, waits for their flips, detects when it is gone.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "hal/clock.h"
#include "hal/linux/kms/draw_surface.h"
#include "hal/linux/kms/drm/connector_watch.h"
#include "hal/linux/kms/mode/output_choice.h"
#include "hal/linux/kms/scanout/flip_events.h"
#include "hal/linux/kms/scanout/scanout.h"
#include "hal/linux/kms/seat.h"
#include "hal/linux/system/flip_pacing.h"

namespace octascope::hal::linux_backend::kms {

// Threads: one at a time.
class Output {
public:
  // All arguments are borrowed and must outlive the Output.
  Output(Clock& clock, Seat& seat, const SeatDevice& device, const Card& card,
         const OutputChoice& choice);
  Output(const Output&) = delete;
  Output& operator=(const Output&) = delete;
  // Restores what the output showed before; afterwards the images shown may be released.
  ~Output();

  bool takes_fences() const { return scanout_->takes_fences(); }
  const std::string& name() const { return name_; } // "/dev/dri/card0 HDMI-A-1"

  // ErrorCode::disconnected: the monitor is gone. If the link must be trained again, calls
  // want_mode().
  Result<> check();

  // The next show() sets the mode again.
  void want_mode() { mode_wanted_ = true; }

  // Returns when the image is visible. Empty: nothing was shown, because another console or program
  // has the card. ErrorCode::disconnected, timed_out, unsupported, system: reopen everything.
  Result<std::optional<FlipTimes>> show(const DrawnPicture& picture);

private:
  Result<std::optional<FlipTimes>> set_mode(const DrawnPicture& picture);
  int submit(const DrawnPicture& picture);
  Result<std::optional<FlipTimes>> wait_for_flip(FlipTimes times);
  std::optional<FlipEvent> read_flip();
  bool link_is_bad() const;

  Clock& clock_;
  Seat& seat_;
  const FileDescriptor& file_;
  const Card& card_;
  const Connector& connector_;
  const Mode mode_;
  const std::string name_;
  std::unique_ptr<Scanout> scanout_;
  SavedCrtc before_;
  ConnectorWatch watch_;
  std::uint64_t number_ = 0; // of the newest flip
  bool mode_wanted_ = true;
};

} // namespace octascope::hal::linux_backend::kms
