// Vessels of another patient, or of the other eye, must not be drawn into a picture.
#pragma once

#include <filesystem>
#include <string>

#include "hal/result.h"
#include "pipeline/whose_eye.h"

namespace octascope::firmware_host {

// "subject 4711, left eye".
std::string in_words(const pipeline::WhoseEye& whose);

// Fault::invalid_argument, with what each says, where the registration is another eye's than the
// picture. What nobody said contradicts nothing.
hal::Result<> check_whose_vessels(const std::filesystem::path& registration,
                                  const pipeline::WhoseEye& vessels,
                                  const pipeline::WhoseEye& picture);

} // namespace octascope::firmware_host
