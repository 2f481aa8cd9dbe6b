#pragma once

#include <string_view>

namespace octascope::firmware_host {

std::string_view version();

} // namespace octascope::firmware_host
