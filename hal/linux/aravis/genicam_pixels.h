// Which of GenICam's pixel formats deliver a line camera's spectra. Names: the EMVA's Pixel Format
// Naming Convention, 2.x. Pure.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hal/line_camera.h"
#include "hal/result.h"

namespace octascope::hal::linux_backend {

// ErrorCode::invalid_argument for what no camera can deliver.
Result<> check_genicam_request(const LineCameraConfig& config);

// The names of formats with this memory layout, best first: "Mono12", "Mono16".
std::vector<std::string_view> genicam_formats_for(const LineFormat& wanted);

// The first of those that the camera offers. ErrorCode::unsupported, with found and expected: none.
Result<std::string> choose_genicam_format(std::span<const std::string> offered,
                                          const LineFormat& wanted);

} // namespace octascope::hal::linux_backend
