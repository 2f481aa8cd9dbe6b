// What has Aravis wait for a camera's answer, where nobody else shall wait for it: one errand after
// another on a thread beside. A camera that went leaves each of Aravis's questions unanswered for 3 s.
#pragma once

#include <chrono>
#include <memory>
#include <thread>
#include <utility>

#include "hal/clock.h"
#include "hal/semaphore.h"

namespace octascope::hal::linux_backend {

// One thread at a time, but for the errands.
class CameraErrands {
public:
  explicit CameraErrands(Clock& clock) : clock_{clock} {}
  CameraErrands(const CameraErrands&) = delete;
  CameraErrands& operator=(const CameraErrands&) = delete;

  // What is not done yet ends by itself some seconds later, or with the process: errands own what
  // they use. Who waited in vain before does not wait again.
  ~CameraErrands() {
    if (!late_)
      wait();
    if (thread_.joinable())
      thread_.detach();
  }

  template <class Errand> void start(Errand errand) {
    auto done = std::make_shared<Semaphore>();
    thread_ =
        std::thread{[before = std::move(thread_), errand = std::move(errand), done]() mutable {
          if (before.joinable())
            before.join();
          errand();
          done->post();
        }};
    done_ = std::move(done);
  }

  // True when all is done. Waits for it for a second; in steps, as a machine that stands still is no
  // camera that does.
  bool wait() {
    using namespace std::chrono_literals;
    for (int step = 0; step < 10 && thread_.joinable(); ++step)
      if (clock_.wait_until(*done_, clock_.now() + 100ms))
        thread_.join();
    late_ = thread_.joinable();
    return !late_;
  }

private:
  Clock& clock_;
  std::thread thread_;
  std::shared_ptr<Semaphore> done_; // posted by the last errand
  bool late_ = false;
};

} // namespace octascope::hal::linux_backend
