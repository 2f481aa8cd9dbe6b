// The line camera that genicam_camera.h promises.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "hal/linux/aravis/aravis_library.h"
#include "hal/linux/aravis/camera_errands.h"
#include "hal/linux/aravis/camera_features.h"
#include "hal/linux/aravis/frame_server.h"
#include "hal/linux/aravis/frame_slots.h"
#include "hal/linux/aravis/genicam_camera.h"
#include "hal/semaphore.h"

namespace octascope::hal::linux_backend {

// All that a camera has from open to close. It is made and ended by errands.
struct OpenCamera {
  explicit OpenCamera(const AravisLibrary& library) : aravis{library} {}

  AravisLibrary aravis;
  std::atomic<bool> lost{false}; // the device said so, on a thread of its own
  Semaphore news;                // of frames, and of that
  Semaphore returns;             // of slots, by any thread
  Reference<ArvCamera> camera;
  CameraStream stream;
  CameraControls controls;
  std::unique_ptr<FrameSlots> slots;
  std::unique_ptr<FrameServer> server; // while streaming
};

// A camera that is being opened; filled by an errand.
struct Opening {
  LineCameraConfig config;
  std::string identity;
  Result<std::unique_ptr<OpenCamera>> camera = nullptr;
};

// A camera that is being started; filled by an errand.
struct Starting {
  Result<std::unique_ptr<FrameServer>> server = nullptr;
};

class AravisLineCamera final : public LineCamera {
public:
  // Without `aravis` the first open() loads it.
  AravisLineCamera(GenicamCameraOptions options, Clock& clock,
                   std::optional<AravisLibrary> aravis = {});
  ~AravisLineCamera() override;

private:
  std::string_view do_backend() const override { return "aravis"; }
  bool do_simulated() const override { return options_.address.simulated(); }
  Result<> do_open(const LineCameraConfig& config) override;
  Result<> do_start() override;
  Result<std::optional<LineFrame>> do_wait_frame(Duration timeout) override;
  void do_release(int buffer) override;
  void do_stop() override;
  void do_close() override;
  std::string do_identity() const override;
  CameraControls do_controls() const override { return open_ ? open_->controls : CameraControls{}; }

  void begin_opening(const LineCameraConfig& config);
  Result<> finish_opening();
  void begin_starting();
  Result<> finish_starting();
  void end_streaming();
  LineFrame handed_out(int slot) const;
  bool lost() const { return open_->lost.load(std::memory_order_acquire); }
  tl::unexpected<Error> gone();

  const GenicamCameraOptions options_;
  const std::string name_; // for messages
  Clock& clock_;

  std::optional<AravisLibrary> aravis_;
  LineCameraConfig config_;
  std::unique_ptr<OpenCamera> open_;   // not while absent
  std::shared_ptr<Opening> opening_;   // asked for by an open() that did not wait for its end
  std::shared_ptr<Starting> starting_; // likewise, of start(); only while `ready`
  CameraErrands errands_;

  mutable std::mutex identity_mutex_; // never taken while streaming
  std::string identity_;              // of the last open
};

} // namespace octascope::hal::linux_backend
