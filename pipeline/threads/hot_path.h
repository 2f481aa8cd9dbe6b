// Marks the hot paths, so that a test and the report can prove that they allocate nothing.
//
// The stretch of a thread's work between construction and destruction of a HotPath is hot. The
// program's allocation functions (firmware-host/allocation.cpp) count every allocation made
// there.
#pragma once

#include <atomic>
#include <cstdint>
#include <utility>

namespace octascope::pipeline {

class HotPath {
public:
  HotPath() { ++depth(); }
  ~HotPath() { --depth(); }
  HotPath(const HotPath&) = delete;
  HotPath& operator=(const HotPath&) = delete;

  static bool active() { return depth() > 0; }

  // Called by the allocation functions; safe anywhere.
  static void count_allocation() {
    if (active())
      counter().fetch_add(1, std::memory_order_relaxed);
  }
  static std::uint64_t allocations() { return counter().load(std::memory_order_relaxed); }

  // A stretch within it that is not: opening a device, which happens when one was lost.
  class Pause {
  public:
    Pause() : depth_{std::exchange(depth(), 0)} {}
    ~Pause() { depth() = depth_; }
    Pause(const Pause&) = delete;
    Pause& operator=(const Pause&) = delete;

  private:
    int depth_;
  };

private:
  // The program's allocation functions are global, and so must be what they count with.
  static int& depth() {
    thread_local constinit int value = 0;
    return value;
  }
  static std::atomic<std::uint64_t>& counter() {
    static constinit std::atomic<std::uint64_t> value{0};
    return value;
  }
};

} // namespace octascope::pipeline
