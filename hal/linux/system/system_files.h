// What the system says of devices in files and folders: /dev, /sys, /proc.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace octascope::hal::linux_backend {

// Without its end; empty if the file cannot be read.
std::string first_line(const std::filesystem::path& file);

// What follows `key` in the first line that begins with it; empty if none does.
std::string text_after(std::string_view key, const std::filesystem::path& file);

// The entries of the folder whose names begin with `prefix`, by name, and by the number at its end:
// video2 before video10. None if the folder cannot be read.
std::vector<std::filesystem::path> entries(const std::filesystem::path& folder,
                                           std::string_view prefix = "");

// Those of them that have nothing but a number after the prefix, with the folder.
std::vector<std::string> numbered_entries(const std::filesystem::path& folder,
                                          std::string_view prefix);

} // namespace octascope::hal::linux_backend
