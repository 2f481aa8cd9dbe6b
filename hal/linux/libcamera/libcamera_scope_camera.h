// The microscope camera through libcamera: a USB camera or one on a board's camera connector.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hal/clock.h"
#include "hal/linux/libcamera/libcamera_session.h"
#include "hal/scope_camera.h"

namespace octascope::hal::linux_backend {

struct LibcameraScopeOptions {
  std::string camera;                   // its id or model, or part of it; empty: first free one
  std::vector<std::string> taken_nodes; // of the line camera, such as "/dev/video0"
};

// NV12, YUYV, RGB and RGBA pixels are delivered in place, without a copy; motion JPEG is decoded
// into a separate buffer, and NV12 with separate planes is copied into one piece. wait_frame()
// returns the newest frame; older frames that were not fetched go back to the camera and show as a
// gap in the sequence, as do broken ones. A camera that has buffers but fills none for three
// seconds has failed: ErrorCode::timed_out. Some cameras ignore the requested frame rate.
//
// Threads: as hal::ScopeCamera. libcamera's thread puts completed requests into a bounded queue.
// While streaming, this class neither allocates nor locks; libcamera does both for each frame.
class LibcameraScopeCamera final : public hal::ScopeCamera {
public:
  // The session and the clock (on CLOCK_MONOTONIC) are borrowed and must outlive the camera.
  LibcameraScopeCamera(LibcameraSession& session, LibcameraScopeOptions options, Clock& clock);
  ~LibcameraScopeCamera() override;

  // Since open(): frames that the driver flagged, JPEGs that could not be decoded. Any thread.
  struct Losses {
    std::uint64_t broken = 0;
    std::uint64_t undecodable = 0;
  };
  Losses losses() const;

private:
  std::string_view do_backend() const override { return "libcamera"; }
  bool do_simulated() const override { return false; }
  Result<> do_open(const ScopeCameraConfig& config) override;
  Result<> do_start() override;
  Result<std::optional<ScopeFrame>> do_wait_frame(Duration timeout) override;
  void do_release(int buffer) override;
  void do_stop() override;
  void do_close() override;

  struct Parts;
  std::unique_ptr<Parts> parts_;
};

} // namespace octascope::hal::linux_backend
