// Writes the pictures that the surgeon takes, beside the running display.
#pragma once

#include <deque>
#include <filesystem>
#include <future>
#include <mutex>

#include "hal/clock.h"
#include "hal/result.h"
#include "pipeline/faults/fault_log.h"
#include "pipeline/files/png_image.h"

namespace octascope::firmware_host {

// Call from one thread; a thread of its own compresses and writes, one picture after another.
class PictureWriter {
public:
  static constexpr std::size_t most_waiting = 4; // 130 MB of 3840x2160

  // Pictures go into `folder`, named by date and time. They show a patient, so only their owner may
  // read them.
  PictureWriter(std::filesystem::path folder, hal::Clock& clock, pipeline::FaultLog& faults)
      : folder_(std::move(folder)), clock_(clock), faults_(faults) {}

  const std::filesystem::path& folder() const { return folder_; }

  // Returns at once. False if as many wait for the disk as may: this one is dropped, and a fault is
  // recorded.
  bool keep(pipeline::Image picture);

private:
  void write_waiting();

  std::filesystem::path folder_;
  hal::Clock& clock_;
  pipeline::FaultLog& faults_;
  std::mutex mutex_;
  std::deque<pipeline::Image> waiting_; // under mutex_; the first is being written
  std::future<void> writing_;           // its destructor waits
};

} // namespace octascope::firmware_host
