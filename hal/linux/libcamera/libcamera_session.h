// libcamera itself: one a process, with a thread of its own that watches cameras come and go.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "hal/linux/libcamera/camera_choice.h"
#include "hal/result.h"

namespace octascope::hal::linux_backend {

// Made once, in the composition root; outlives the cameras that borrow it. What libcamera writes
// to stderr is silenced, unless the environment has LIBCAMERA_LOG_LEVELS: our Errors say it.
//
// libcamera notices by itself that a USB camera goes, and no other kind: a camera that is gone
// stays listed, and should it come back, ends the program for its double name. So whoever finds
// that a camera is gone calls restart().
//
// Threads: any.
class LibcameraSession {
public:
  // libcamera begins at the first question, in whose thread it is asked: it opens each media device
  // for a moment, some tens of ms. ErrorCode::busy: this process has a session already (libcamera
  // would end the program). No camera is no error.
  static Result<std::unique_ptr<LibcameraSession>> start();
  LibcameraSession(const LibcameraSession&) = delete;
  LibcameraSession& operator=(const LibcameraSession&) = delete;
  ~LibcameraSession();

  // What is plugged in now. `taken_nodes` ("/dev/video0") are the line camera's.
  std::vector<LibcameraFound> cameras(const std::vector<std::string>& taken_nodes = {});

  // The one that serves (choose_camera), or the Error that says why none does.
  struct Chosen; // for LibcameraScopeCamera: camera_link.h
  Result<Chosen> choose(const std::string& wish, const std::vector<std::string>& taken_nodes);

  // Begins anew at the next question; cameras that are held meanwhile are of no use any more.
  void restart();

private:
  struct Parts;
  explicit LibcameraSession(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

} // namespace octascope::hal::linux_backend
