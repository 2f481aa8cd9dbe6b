// From libcamera's thread to the thread that waits for frames: which requests have completed, and
// whether the camera is gone.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "hal/semaphore.h"

namespace octascope::hal::linux_backend {

constexpr std::size_t most_buffers = 32;

// Bounded: a request is in it at most once, so `most_buffers` places are enough.
// Threads: add() and close() from libcamera's thread, the rest from the waiting thread.
class CompletionQueue {
public:
  // Empties the queue and accepts only this camera's messages from now on. The previous camera must
  // have been stopped.
  void listen_to(const void* camera) {
    while (next())
      ;
    gone_.store(false, std::memory_order_relaxed);
    camera_.store(camera, std::memory_order_release);
  }

  void add(const void* camera, std::uint64_t request) {
    if (camera_.load(std::memory_order_acquire) != camera || request >= most_buffers)
      return;
    const std::uint32_t end = end_.load(std::memory_order_relaxed);
    if (end - begin_.load(std::memory_order_acquire) == most_buffers)
      return;
    places_[end % most_buffers] = static_cast<std::uint8_t>(request);
    end_.store(end + 1, std::memory_order_release);
    semaphore_.post();
  }
  void close(const void* camera) {
    if (camera_.load(std::memory_order_acquire) != camera)
      return;
    gone_.store(true, std::memory_order_release);
    semaphore_.post();
  }

  // Takes the oldest completed request.
  std::optional<std::size_t> next() {
    const std::uint32_t begin = begin_.load(std::memory_order_relaxed);
    if (begin == end_.load(std::memory_order_acquire))
      return std::nullopt;
    const std::size_t request = places_[begin % most_buffers];
    begin_.store(begin + 1, std::memory_order_release);
    return request;
  }
  bool gone() const { return gone_.load(std::memory_order_acquire); }
  // Posted by each add() and close().
  Semaphore& semaphore() { return semaphore_; }

private:
  std::array<std::uint8_t, most_buffers> places_{};
  std::atomic<std::uint32_t> begin_{0};
  std::atomic<std::uint32_t> end_{0};
  std::atomic<const void*> camera_{nullptr};
  std::atomic<bool> gone_{false};
  Semaphore semaphore_;
};

} // namespace octascope::hal::linux_backend
