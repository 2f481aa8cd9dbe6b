// File sizes as text: "69.8 MB", "4.21 GB".
#pragma once

#include <cstdint>
#include <string>

namespace octascope::firmware_host {

std::string size_words(std::uint64_t bytes);

} // namespace octascope::firmware_host
