// One camera of libcamera's, configured, with its buffers mapped: what the scope camera is made of.
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

// Puts the signals of cameras into the queue. A signal of libcamera's must not be disconnected
// while its thread may be emitting it, so each camera is connected once, for as long as it lives;
// after that the queue takes signals of the current camera alone.
class SignalListener {
public:
  void listen_to(const std::shared_ptr<libcamera::Camera>& camera);
  void listen_to_none() { queue_->listen_to(nullptr); }
  CompletionQueue& queue() { return *queue_; }

private:
  std::shared_ptr<CompletionQueue> queue_ = std::make_shared<CompletionQueue>();
  std::vector<std::weak_ptr<libcamera::Camera>> connected_;
};

// Threads: one at a time. Its destructor stops the camera and gives it back.
//
// But libcamera 0.0.3 can neither stop nor drop a streaming camera that is gone, unless it noticed
// itself (it does for USB cameras, and tells the queue), nor one that gave up a request: it ends
// the program. Such a camera is abandoned, and the session is to be restarted: its objects, some
// descriptors (those of its nodes lead nowhere then) and a sleeping thread stay until the program
// ends.
class CameraLink {
public:
  // ErrorCode::busy: another program has it. ErrorCode::unsupported: no format that can be drawn.
  static Result<std::unique_ptr<CameraLink>> open(const LibcameraSession::Chosen& chosen,
                                                  const ScopeCameraConfig& config);
  // Nobody has it, in this program or in another one that uses libcamera.
  static bool is_free(const LibcameraSession::Chosen& chosen);
  CameraLink(const CameraLink&) = delete;
  CameraLink& operator=(const CameraLink&) = delete;
  ~CameraLink();

  const std::string& model() const;
  const PictureLayout& layout() const;
  std::size_t buffers() const;

  Result<> start(Duration period);
  // Returns when no request is under way any more; all that were are in the queue. Call it with as
  // few under way as can be waited for: should the camera vanish in this very moment, libcamera
  // 0.0.3 ends the program if there is one.
  void stop();
  // False: it was unplugged.
  bool present() const;
  bool can_be_stopped() const;    // false: it is or was gone, or gave up a request
  bool will_be_abandoned() const; // when this is destroyed; the session is restarted before
  // Of one that will be abandoned, when the session was restarted and has not begun anew: its
  // nodes, which it would hold and stream on for ever, are for others to open. Loans stay readable.
  void shut_nodes();
  bool watched() const; // CameraNodes::watched
  // Libcamera noticed that the camera is gone, and has stopped it by itself.
  void stopped_by_itself();
  // Gives the camera a buffer to fill. Allocates nothing of ours; libcamera allocates a message to
  // its thread.
  Result<> queue(std::size_t buffer);

  // Of each request that the queue brings while it streams: whether the camera gave it up. From
  // the first such on it cannot be stopped any more.
  bool given_up(std::size_t buffer);

  // Of one that it did not give up. `bytes` stay readable until queue(buffer): the picture, or the
  // JPEG.
  struct Completed {
    bool good = false; // else the driver flagged it, and `bytes` is empty
    FrameStamp stamp;
    std::span<const std::byte> bytes;
  };
  Completed completed(std::size_t buffer);

private:
  struct Parts;
  explicit CameraLink(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

} // namespace octascope::hal::linux_backend
