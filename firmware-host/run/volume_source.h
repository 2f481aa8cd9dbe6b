// Loads one volume for commands that draw or measure: from a file, from spectra, or of a phantom.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "firmware-host/configuration/run_options.h"
#include "hal/result.h"
#include "pipeline/volume/patient_eye.h"
#include "pipeline/volume/volume.h"

namespace octascope::firmware_host {

// Exactly one of `file`, `recording` and `phantom`.
struct VolumeRequest {
  std::optional<std::filesystem::path> file; // NRRD, or a recording: its content says which
  std::optional<std::size_t> at; // which volume of a recording, from 0; empty: the first
  std::optional<RecordingOptions> recording;
  std::optional<std::filesystem::path> calibration; // of the recording
  std::optional<std::string> phantom;
};

struct LoadedVolume {
  pipeline::Volume volume;
  pipeline::PatientEye whose;            // from the recording; otherwise not said
  std::vector<std::string> remarks = {}; // what was assumed or left out, for the user
};

// As the running appliance would show it: the same calibration, reconstruction and averaging of
// neighbours for spectra and phantoms; a file's levels unchanged. ErrorCode::invalid_argument for
// what a user can correct on the command line.
hal::Result<LoadedVolume> load_volume(const VolumeRequest& request);

} // namespace octascope::firmware_host
