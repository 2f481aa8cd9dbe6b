// Writes registrations that the surgeon has made with the knob, beside the running display.
#pragma once

#include <filesystem>
#include <optional>

#include "hal/result.h"
#include "pipeline/threads/background_task.h"
#include "pipeline/vessels/registration.h"

namespace octascope::firmware_host {

// One thread asks; a thread of its own writes, one file at a time.
class RegistrationWriter {
public:
  // Files go into `folder`, named by date and time: none is ever overwritten.
  explicit RegistrationWriter(std::filesystem::path folder) : folder_{std::move(folder)} {}

  // Where the tree lies now, and whose vessels they are. `source`, for people: what it was before
  // it was moved. Returns at once; false while the last one is still being written.
  bool keep(const pipeline::RigidTransform& volume_from_tree, pipeline::PatientEye whose,
            std::string source);

  // The file, or why there is none; once for each keep().
  std::optional<hal::Result<std::filesystem::path>> take() { return writing_.take(); }

private:
  std::filesystem::path folder_;
  pipeline::BackgroundTask<hal::Result<std::filesystem::path>> writing_;
};

} // namespace octascope::firmware_host
