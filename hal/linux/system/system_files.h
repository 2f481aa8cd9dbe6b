// Reads what the system says in /dev, /sys and /proc.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace octascope::hal::linux_backend {

// Without the line feed; empty if the file cannot be read.
std::string first_line(const std::filesystem::path& file);

// The rest of the first line that begins with `key`; empty if no line does.
std::string text_after(std::string_view key, const std::filesystem::path& file);

// The folder's entries whose names begin with `prefix`, sorted by name and the number at its end,
// so video2 before video10. Empty if the folder cannot be read.
std::vector<std::filesystem::path> entries(const std::filesystem::path& folder,
                                           std::string_view prefix = "");

// Those whose name is the prefix and a number, as paths.
std::vector<std::string> numbered_entries(const std::filesystem::path& folder,
                                          std::string_view prefix);

} // namespace octascope::hal::linux_backend
