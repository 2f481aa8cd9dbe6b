// Names for files that are kept side by side.
#pragma once

#include <filesystem>
#include <string_view>

namespace octascope::firmware_host {

// FOLDER/PREFIX-20261121-171903EXTENSION, in local time, with a number added if that name is taken.
std::filesystem::path free_dated_name(const std::filesystem::path& folder, std::string_view prefix,
                                      std::string_view extension);

} // namespace octascope::firmware_host
