// Loads a vessel tree beside the running display.
#pragma once

#include <atomic>
#include <filesystem>
#include <optional>
#include <thread>

#include "firmware-host/vessels/vessel_source.h"
#include "hal/result.h"
#include "pipeline/threads/wakeup.h"

namespace octascope::firmware_host {

// One thread of its own loads; another asks.
class VesselLoader {
public:
  // Begins at once. `news`, which outlives this, is posted at each hundredth and at the end.
  VesselLoader(std::filesystem::path file, pipeline::Wakeup& news);
  // Breaks it off: reading ends within a tenth of a second or so.
  ~VesselLoader() = default;

  const std::filesystem::path& file() const { return file_; }
  float progress() const { return progress_.load(std::memory_order_relaxed); } // 0…1

  // What came of it, once.
  std::optional<hal::Result<LoadedVessels>> take();

private:
  void note(double progress);

  std::filesystem::path file_;
  pipeline::Wakeup& news_;
  std::atomic<float> progress_{0};
  std::optional<hal::Result<LoadedVessels>> loaded_; // the thread's until `done_`
  std::atomic<bool> done_{false};
  std::jthread thread_; // its end asks for the stop, and waits
};

} // namespace octascope::firmware_host
