// Writes registrations made with the knob, beside the running display.
#pragma once

#include <filesystem>
#include <optional>

#include "hal/result.h"
#include "pipeline/threads/background_task.h"
#include "pipeline/vessels/registration.h"

namespace octascope::firmware_host {

// Call from one thread; a thread of its own writes, one file at a time.
class RegistrationWriter {
public:
  // Files go into `folder`, named by date and time; none is overwritten.
  explicit RegistrationWriter(std::filesystem::path folder) : folder_{std::move(folder)} {}

  // The tree's present place and the patient's eye it belongs to. `source`, for people: the
  // registration before it was moved. Returns at once; false while the last one is still being
  // written.
  bool keep(const pipeline::RigidTransform& volume_from_tree, pipeline::PatientEye whose,
            std::string source);

  // The file or the error; once for each keep().
  std::optional<hal::Result<std::filesystem::path>> take() { return writing_.take(); }

private:
  std::filesystem::path folder_;
  pipeline::BackgroundTask<hal::Result<std::filesystem::path>> writing_;
};

} // namespace octascope::firmware_host
