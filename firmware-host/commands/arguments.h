// Arguments that several commands take, from text to value.
#pragma once

#include <array>
#include <string_view>

#include "hal/result.h"

namespace octascope::firmware_host {

// "1280x720": width and height, each 1 to 16384.
hal::Result<std::array<int, 2>> parse_size(std::string_view text);

} // namespace octascope::firmware_host
