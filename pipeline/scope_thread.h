// The thread of the scope camera: keeps the newest microscope picture for the renderer.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <thread>
#include <vector>

#include "hal/clock.h"
#include "hal/scope_camera.h"
#include "pipeline/fault_log.h"
#include "pipeline/retry_delay.h"
#include "pipeline/triple_buffer.h"
#include "pipeline/worker_pool.h"

namespace octascope::pipeline {

// 8-bit RGB, rows from the top, no padding.
struct ScopePicture {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgb;
  std::uint64_t sequence = 0;
  hal::TimePoint time;
};

// The camera may vanish and return at any time; it is reopened with a back-off.
class ScopeThread {
public:
  // All references outlive this.
  ScopeThread(hal::ScopeCamera& camera, const hal::ScopeCameraConfig& config, hal::Clock& clock,
              FaultLog& faults);
  ~ScopeThread();

  void start(const ThreadSetup& setup);
  void stop();

  // The renderer's side (one thread): the newest picture if one came since the last call; valid
  // until the next call that returns one.
  const ScopePicture* take_newest();

private:
  void run();
  bool open_and_start();
  void fault(const hal::Error& error);
  bool receive(const hal::ScopeFrame& frame);

  hal::ScopeCamera& camera_;
  hal::ScopeCameraConfig config_;
  hal::Clock& clock_;
  FaultLog& faults_;
  std::array<ScopePicture, 3> pictures_;
  std::uint32_t back_ = 2;
  TripleBuffer triple_buffer_{0, 1};
  RetryDelay retry_;
  std::atomic<bool> stopping_{false};
  std::thread thread_;
};

} // namespace octascope::pipeline
