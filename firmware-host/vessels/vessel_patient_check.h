// Vessels of another patient, or of the other eye, must not be drawn into a picture.
#pragma once

#include <filesystem>
#include <string>

#include "hal/result.h"
#include "pipeline/volume/patient_eye.h"

namespace octascope::firmware_host {

// "subject 4711, left eye".
std::string in_words(const pipeline::PatientEye& whose);

// ErrorCode::invalid_argument, with what each says, where the registration is another eye's than
// the picture. What nobody said contradicts nothing.
hal::Result<> check_vessel_patient(const std::filesystem::path& registration,
                                   const pipeline::PatientEye& vessels,
                                   const pipeline::PatientEye& picture);

} // namespace octascope::firmware_host
