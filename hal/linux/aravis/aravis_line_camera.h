// The line camera that genicam_camera.h promises.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "hal/linux/aravis/aravis_library.h"
#include "hal/linux/aravis/camera_features.h"
#include "hal/linux/aravis/frame_server.h"
#include "hal/linux/aravis/frame_slots.h"
#include "hal/linux/aravis/genicam_camera.h"
#include "hal/semaphore.h"

namespace octascope::hal::linux_backend {

class AravisLineCamera final : public LineCamera {
public:
  AravisLineCamera(GenicamCameraOptions options, Clock& clock);
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

  Result<> open_camera_of(const LineCameraConfig& config);
  Result<> start_stream();
  void watch();
  bool stop_acquisition();
  void close_beside();
  Result<> wait_until_closed();
  LineFrame handed_out(int slot) const;
  tl::unexpected<Error> gone();

  const GenicamCameraOptions options_;
  const std::string name_; // for messages
  Clock& clock_;

  std::optional<AravisLibrary> aravis_;
  LineCameraConfig config_;
  CameraStream stream_;
  std::atomic<bool> lost_{false}; // the device said so, on a thread of its own
  Semaphore news_;                // of frames, and of that
  Semaphore returns_;             // of slots, by any thread
  Reference<ArvCamera> camera_;
  gulong watch_ = 0; // the handler of that news
  std::unique_ptr<FrameSlots> slots_;
  std::unique_ptr<FrameServer> server_; // while streaming

  // A camera that went is closed beside the camera thread: Aravis waits seconds for its answers.
  std::thread closing_;
  Semaphore closed_;

  mutable std::mutex identity_mutex_; // never taken while streaming
  std::string identity_;              // of the last open
};

} // namespace octascope::hal::linux_backend
