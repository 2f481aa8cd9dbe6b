#include "pipeline/files/file_name.h"

#include <algorithm>
#include <system_error>

namespace octascope::pipeline {

namespace fs = std::filesystem;

std::string small_letters(std::string text) {
  std::ranges::transform(text, text.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  return text;
}

std::string file_ending(const fs::path& file) {
  return small_letters(file.extension().string());
}

bool is_same_file(const fs::path& a, const fs::path& b) {
  std::error_code absent;
  if (fs::equivalent(a, b, absent) && !absent)
    return true;
  std::error_code error;
  const fs::path first = fs::weakly_canonical(fs::absolute(a, error), error);
  return !error && first == fs::weakly_canonical(fs::absolute(b, error), error) && !error;
}

} // namespace octascope::pipeline
