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

// A thread of its own loads; call from one other thread.
class VesselLoader {
public:
  // Begins at once. `news`, which outlives this, is posted at each hundredth and at the end.
  VesselLoader(std::filesystem::path file, pipeline::Wakeup& news);
  // Cancels the loading, within about a tenth of a second.
  ~VesselLoader() = default;

  const std::filesystem::path& file() const { return file_; }
  float progress() const { return progress_.load(std::memory_order_relaxed); } // 0…1

  // The outcome, once.
  std::optional<hal::Result<LoadedVessels>> take();

private:
  void note(double progress);

  std::filesystem::path file_;
  pipeline::Wakeup& news_;
  std::atomic<float> progress_{0};
  std::optional<hal::Result<LoadedVessels>> loaded_; // owned by the thread until `done_`
  std::atomic<bool> done_{false};
  std::jthread thread_; // last: its destructor stops and joins it
};

} // namespace octascope::firmware_host
