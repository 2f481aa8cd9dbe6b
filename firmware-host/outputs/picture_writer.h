// Writes the pictures that the surgeon takes, beside the running display.
#pragma once

#include <filesystem>

#include "hal/clock.h"
#include "hal/result.h"
#include "pipeline/faults/fault_log.h"
#include "pipeline/files/png_image.h"
#include "pipeline/threads/background_task.h"

namespace octascope::firmware_host {

// Call from one thread; a thread of its own compresses and writes, one picture at a time.
class PictureWriter {
public:
  // Pictures go into `folder`, named by date and time. They show a patient, so only their owner may
  // read them.
  PictureWriter(std::filesystem::path folder, hal::Clock& clock, pipeline::FaultLog& faults)
      : folder_(std::move(folder)), clock_(clock), faults_(faults) {}

  const std::filesystem::path& folder() const { return folder_; }

  // Returns at once. False if the last picture is still being written: this one is dropped, and a
  // fault is recorded.
  bool keep(pipeline::Image picture);

private:
  std::filesystem::path folder_;
  hal::Clock& clock_;
  pipeline::FaultLog& faults_;
  pipeline::BackgroundTask<hal::Result<>> writing_;
};

} // namespace octascope::firmware_host
