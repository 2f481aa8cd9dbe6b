// What a file's name says.
#pragma once

#include <filesystem>
#include <string>

namespace octascope::pipeline {

// With A to Z in small letters: cameras and other systems write capitals.
std::string small_letters(std::string text);

// The ending in small letters, as ".png" of PICTURE.PNG; empty without one.
std::string file_ending(const std::filesystem::path& file);

// Whether two names lead to the same file, also through links, hard links and linked folders; or
// would, once it is there.
bool is_same_file(const std::filesystem::path& a, const std::filesystem::path& b);

} // namespace octascope::pipeline
