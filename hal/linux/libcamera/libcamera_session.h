// libcamera's camera manager: one per process. Its own thread watches cameras being plugged in and
// unplugged.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "hal/linux/libcamera/camera_choice.h"
#include "hal/result.h"

namespace octascope::hal::linux_backend {

// Created once, in the composition root; must outlive the cameras that borrow it. libcamera's
// output to stderr is silenced unless LIBCAMERA_LOG_LEVELS is set: our Errors say the same.
//
// libcamera notices only when USB cameras are unplugged. Any other kind stays listed, and libcamera
// ends the program over the duplicate name if it comes back. So call restart() when a camera is
// found to be gone.
//
// Thread-safe.
class LibcameraSession {
public:
  // libcamera itself starts at the first cameras() or choose(), on the calling thread: it briefly
  // opens each media device, which takes some tens of ms. ErrorCode::busy: this process already has
  // a session (libcamera would end the program). Finding no camera is not an error.
  static Result<std::unique_ptr<LibcameraSession>> start();
  LibcameraSession(const LibcameraSession&) = delete;
  LibcameraSession& operator=(const LibcameraSession&) = delete;
  ~LibcameraSession();

  // The cameras that are plugged in. `taken_nodes` are the line camera's, such as "/dev/video0".
  std::vector<LibcameraFound> cameras(const std::vector<std::string>& taken_nodes = {});

  // The camera to use (see choose_camera), or an Error that says why there is none.
  struct Chosen; // for LibcameraScopeCamera: camera_link.h
  Result<Chosen> choose(const std::string& wanted, const std::vector<std::string>& taken_nodes);

  // libcamera starts again at the next cameras() or choose(). Cameras that are still held become
  // useless.
  void restart();

private:
  struct Parts;
  explicit LibcameraSession(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

} // namespace octascope::hal::linux_backend
