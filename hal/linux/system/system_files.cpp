#include "hal/linux/system/system_files.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <system_error>
#include <utility>

#include "hal/number_text.h"

namespace octascope::hal::linux_backend {

namespace fs = std::filesystem;

namespace {

std::pair<std::string, unsigned long> name_and_number(const fs::path& path) {
  const std::string name = path.filename().string();
  const auto digits = name.find_last_not_of("0123456789") + 1;
  return {name.substr(0, digits), std::strtoul(name.c_str() + digits, nullptr, 10)};
}

} // namespace

std::string first_line(const fs::path& file) {
  std::string line;
  std::getline(std::ifstream{file}, line);
  return line;
}

std::string text_after(std::string_view key, const fs::path& file) {
  std::ifstream in{file};
  for (std::string line; std::getline(in, line);)
    if (line.starts_with(key))
      return line.substr(key.size());
  return {};
}

std::vector<fs::path> entries(const fs::path& folder, std::string_view prefix) {
  std::vector<fs::path> found;
  std::error_code error;
  for (fs::directory_iterator it{folder, error}, end; !error && it != end; it.increment(error))
    if (it->path().filename().string().starts_with(prefix))
      found.push_back(it->path());
  std::ranges::sort(found, {}, name_and_number);
  return found;
}

std::vector<std::string> numbered_entries(const fs::path& folder, std::string_view prefix) {
  std::vector<std::string> found;
  for (const fs::path& path : entries(folder, prefix))
    if (number_of<unsigned>(path.filename().string().substr(prefix.size())))
      found.push_back(path.string());
  return found;
}

} // namespace octascope::hal::linux_backend
