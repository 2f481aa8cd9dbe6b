// One configured libcamera camera with its buffers mapped, for LibcameraScopeCamera.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "hal/linux/libcamera/camera_nodes.h"
#include "hal/linux/libcamera/completion_queue.h"
#include "hal/linux/libcamera/format_choice.h"
#include "hal/linux/libcamera/frame_order.h"
#include "hal/linux/libcamera/libcamera_session.h"
#include "hal/linux/libcamera/plane_plan.h"
#include "hal/result.h"
#include "hal/scope_camera.h"

namespace libcamera {
class Camera;
}

namespace octascope::hal::linux_backend {

struct LibcameraSession::Chosen {
  std::shared_ptr<libcamera::Camera> camera;
  std::string model;
  CameraNodes nodes;
};

// Forwards the cameras' signals to the queue. A libcamera signal must not be disconnected while
// libcamera's thread may be emitting it, so each camera is connected once, for its lifetime; the
// queue accepts only the current camera's signals.
class SignalListener {
public:
  void listen_to(const std::shared_ptr<libcamera::Camera>& camera);
  void listen_to_none() { queue_->listen_to(nullptr); }
  CompletionQueue& queue() { return *queue_; }

private:
  std::shared_ptr<CompletionQueue> queue_ = std::make_shared<CompletionQueue>();
  std::vector<std::weak_ptr<libcamera::Camera>> connected_;
};

// Threads: one at a time. The destructor stops and releases the camera.
//
// But libcamera 0.0.3 ends the program on stopping or destroying a streaming camera that has
// cancelled a request, or that is gone without libcamera having noticed (it notices for USB
// cameras, and tells the queue). Such a camera is abandoned and the session must be restarted: its
// objects, some descriptors (those of its nodes lead nowhere) and a sleeping thread remain until
// the program ends.
class CameraLink {
public:
  // ErrorCode::busy: another program uses it. ErrorCode::unsupported: it has no format that can be
  // drawn.
  static Result<std::unique_ptr<CameraLink>> open(const LibcameraSession::Chosen& chosen,
                                                  const ScopeCameraConfig& config);
  // False if this program or another one that uses libcamera has acquired it.
  static bool is_free(const LibcameraSession::Chosen& chosen);
  CameraLink(const CameraLink&) = delete;
  CameraLink& operator=(const CameraLink&) = delete;
  ~CameraLink();

  const std::string& model() const;
  const PictureLayout& layout() const;
  std::size_t buffers() const;

  Result<> start(Duration period);
  // Returns when no request is pending; all that were are in the queue. First wait for as many
  // requests as possible to complete: if the camera vanishes during stop() while one is pending,
  // libcamera 0.0.3 ends the program.
  void stop();
  // False if it was unplugged.
  bool present() const;
  bool can_be_stopped() const;    // false: it is or was gone, or has cancelled a request
  bool will_be_abandoned() const; // on destruction; the session must be restarted before
  // For a camera that will be abandoned, after the session's restart() and before its next use:
  // closes the camera's nodes, which it would otherwise hold and stream from for ever, so that
  // others can open them. Borrowed frames stay readable.
  void shut_nodes();
  bool watched() const; // CameraNodes::watched
  // To be called when libcamera has noticed that the camera is gone, and so has stopped it.
  void stopped_by_itself();
  // Gives the camera a buffer to fill. Allocates nothing itself, but libcamera allocates a message
  // to its thread.
  Result<> queue(std::size_t buffer);

  // Call it for each request from the queue while streaming: whether the camera cancelled it. After
  // the first one that it did, the camera can no longer be stopped.
  bool given_up(std::size_t buffer);

  // A request that was not cancelled. `bytes`, the image or the JPEG, stay readable until
  // queue(buffer).
  struct Completed {
    bool good = false; // false: the driver flagged an error, and `bytes` is empty
    RequestStamp stamp;
    std::span<const std::byte> bytes;
  };
  Completed completed(std::size_t buffer);

private:
  struct Parts;
  explicit CameraLink(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

} // namespace octascope::hal::linux_backend
