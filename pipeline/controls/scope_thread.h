// The microscope camera's thread: keeps the newest picture for the renderer.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "hal/clock.h"
#include "hal/scope_camera.h"
#include "pipeline/faults/fault_log.h"
#include "pipeline/threads/retry_delay.h"
#include "pipeline/threads/role_thread.h"
#include "pipeline/threads/triple_buffer.h"
#include "pipeline/threads/wakeup.h"

namespace octascope::pipeline {

// The camera may disconnect and return at any time; it is reopened with a back-off.
class ScopeThread {
public:
  // All references outlive this; `news` is posted after each picture.
  ScopeThread(hal::ScopeCamera& camera, const hal::ScopeCameraConfig& config, hal::Clock& clock,
              FaultLog& faults, Wakeup& news);

  void start(const ThreadSetup& setup);
  void stop() { thread_.stop(); }

  // Renderer's thread only. The newest picture, in the camera's own pixel format, or null if none
  // came since the last call; valid until the next call that returns one. It is a copy, so the
  // camera may disconnect meanwhile.
  const hal::ScopeFrame* take_newest();

private:
  struct Picture {
    hal::ScopeFrame frame; // its pixels point into `bytes`
    std::vector<std::byte> bytes;
  };

  void run();
  bool open_and_start();
  void fault(const hal::Error& error);
  void receive(const hal::ScopeFrame& frame);

  hal::ScopeCamera& camera_;
  hal::ScopeCameraConfig config_;
  hal::Clock& clock_;
  FaultLog& faults_;
  Wakeup& news_;
  std::array<Picture, 3> pictures_;
  std::uint32_t back_ = 2;
  TripleBuffer triple_buffer_{0, 1};
  RetryDelay retry_;
  RoleThread thread_;
};

} // namespace octascope::pipeline
