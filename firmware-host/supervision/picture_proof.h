// Proof that the picture on the glass is current and truthful; the watchdog is kicked by it.
#pragma once

#include <atomic>
#include <cstdint>

namespace octascope::firmware_host {

// Written by the render thread, read by any; wait-free.
class PictureProof {
public:
  // A frame reached the glass whose state was judged within the time limit; it showed a volume, or
  // none had arrived yet.
  void shown(bool volume) {
    if (volume)
      volume_frames_.fetch_add(1, std::memory_order_relaxed);
    frames_.fetch_add(1, std::memory_order_relaxed);
    steps_.fetch_add(1, std::memory_order_release);
  }
  // There is no display, and a restart would not bring one: it was looked for just now.
  void looked_for_display() { steps_.fetch_add(1, std::memory_order_release); }

  std::uint64_t frames() const { return frames_.load(std::memory_order_acquire); }
  std::uint64_t volume_frames() const { return volume_frames_.load(std::memory_order_acquire); }
  // Increases as long as the program need not be restarted.
  std::uint64_t steps() const { return steps_.load(std::memory_order_acquire); }

private:
  std::atomic<std::uint64_t> frames_{0}, volume_frames_{0}, steps_{0};
};

} // namespace octascope::firmware_host
