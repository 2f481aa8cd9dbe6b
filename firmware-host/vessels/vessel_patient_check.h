// Refuses to draw vessels of another patient or of the other eye into a picture.
#pragma once

#include <filesystem>
#include <string>

#include "hal/result.h"
#include "pipeline/volume/patient_eye.h"

namespace octascope::firmware_host {

// "subject 4711, left eye".
std::string in_words(const pipeline::PatientEye& whose);

// ErrorCode::invalid_argument, with both values, if the registration is for another subject or eye
// than the picture. Unknown values match anything.
hal::Result<> check_vessel_patient(const std::filesystem::path& registration,
                                   const pipeline::PatientEye& vessels,
                                   const pipeline::PatientEye& picture);

} // namespace octascope::firmware_host
