// Names for files that are kept one beside the other.
#pragma once

#include <filesystem>
#include <string_view>

namespace octascope::firmware_host {

// FOLDER/PREFIX-20261121-171903EXTENSION, by local time; a number is added where that is there
// already, so that two of one second both stay.
std::filesystem::path free_dated_name(const std::filesystem::path& folder, std::string_view prefix,
                                      std::string_view extension);

} // namespace octascope::firmware_host
