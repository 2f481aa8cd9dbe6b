// The simulated microscope camera: sees the phantom from above.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "hal/scope_camera.h"
#include "pipeline/volume/volume.h"
#include "sim/devices/scope_picture.h"
#include "sim/phantoms/phantom.h"

namespace octascope::sim {

struct SimScopeCameraOptions {
  std::string phantom = "anterior_eye";
  std::uint64_t seed = 1;                              // of the volume loop, for the same phantom
  pipeline::VolumeGeometry field;                      // the OCT scan, for scan_field()
  hal::Duration loop = std::chrono::milliseconds{850}; // one loop of the phantom's motion
  int width = 640;                                     // of its pictures, whatever open() requests
  int height = 480;
};

// Draws 30 pictures per second of the loop, 300 at most, each when first needed, and delivers them in place, so
// that from the second loop on streaming costs next to nothing. Frame n is exposed n periods after
// start(). Frames that are not fetched, or that find all four buffers on loan, are lost together
// with their sequence numbers.
//
// Threads as hal::ScopeCamera; unplug(), replug() and scan_field() may be called from any thread.
class SimScopeCamera final : public hal::ScopeCamera {
public:
  // Draws the static part of the pictures: a tenth of a second. Borrows the clock.
  static hal::Result<std::unique_ptr<SimScopeCamera>> make(const SimScopeCameraOptions& options,
                                                           hal::Clock& clock);

  // Simulates a pulled cable; a wait in progress returns within a frame's time. The state becomes
  // `failed` when the camera's thread notices.
  void unplug() { plugged_.store(false, std::memory_order_release); }
  void replug() { plugged_.store(true, std::memory_order_release); }

  // The field of the OCT scan within the picture.
  PictureRectangle scan_field() const { return scan_field_; }

private:
  SimScopeCamera(const SimScopeCameraOptions& options, hal::Clock& clock,
                 std::unique_ptr<const Phantom> phantom);

  std::string_view do_backend() const override { return "sim"; }
  bool do_simulated() const override { return true; }
  hal::Result<> do_open(const hal::ScopeCameraConfig& config) override;
  hal::Result<> do_start() override;
  hal::Result<std::optional<hal::ScopeFrame>> do_wait_frame(hal::Duration timeout) override;
  void do_release(int buffer) override;
  void do_stop() override;
  void do_close() override;

  hal::Result<> check_cable();
  void forget_loans();
  int borrow_buffer();
  hal::ScopeFrame frame(std::int64_t number, int buffer);
  std::span<const std::uint8_t> pixels_at(double phase); // 0 ≤ phase < 1

  hal::Clock& clock_;
  int width_;
  int height_;
  hal::Duration loop_;
  std::unique_ptr<const Phantom> phantom_;
  ScopePicture picture_;
  PictureRectangle scan_field_;
  std::vector<std::vector<std::uint8_t>> pictures_; // empty: not drawn yet

  std::atomic<bool> plugged_{true};
  std::array<std::atomic<bool>, 4> on_loan_{};
  hal::Duration period_{};
  hal::TimePoint started_;
  std::int64_t next_ = 0; // the first frame not yet delivered
};

} // namespace octascope::sim
