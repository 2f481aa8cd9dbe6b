// The scope camera by libcamera: USB cameras and those on a board's camera connector alike.
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
  std::string camera;                   // its id or model, or a part; empty: the first that is free
  std::vector<std::string> taken_nodes; // "/dev/video0": the line camera's
};

// Pixels are handed out where the camera's driver wrote them (NV12, YUYV, RGB, RGBA); motion JPEG
// is decoded into buffers of ours, and an NV12 picture whose planes lie apart is put together. A
// wait hands out the newest frame; older ones that nobody fetched go back to the camera and show as
// a gap in the sequence, like those that arrive broken. A camera that fills no buffer for three
// seconds, with buffers to fill, has failed: ErrorCode::timed_out. The camera is asked for the
// wished rate, but some have one of their own.
//
// Threads as hal::ScopeCamera. libcamera's thread puts completed requests into a bounded queue.
// Nothing here allocates or locks once it streams; libcamera itself does both for each frame.
class LibcameraScopeCamera final : public hal::ScopeCamera {
public:
  // The session and the clock (CLOCK_MONOTONIC's) outlive this.
  LibcameraScopeCamera(LibcameraSession& session, LibcameraScopeOptions options, Clock& clock);
  ~LibcameraScopeCamera() override;

  // Since open(): frames that the driver flagged, JPEGs that could not be decoded. Threads: any.
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
