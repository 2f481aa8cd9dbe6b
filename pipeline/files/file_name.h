// File names: endings, and whether two name the same file.
#pragma once

#include <filesystem>
#include <string>

namespace octascope::pipeline {

// A to Z become small letters: cameras and other systems write capitals.
std::string small_letters(std::string text);

// The ending in small letters, as ".png" of PICTURE.PNG; empty without one.
std::string file_ending(const std::filesystem::path& file);

// Whether two names mean the same file, also through links, hard links and linked folders. The file
// need not exist yet.
bool is_same_file(const std::filesystem::path& a, const std::filesystem::path& b);

} // namespace octascope::pipeline
