// A folder of its own for a test that writes files; gone with the object.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>
#include <string_view>
#include <system_error>

namespace octascope::tests {

class ScratchFolder {
public:
  ScratchFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "octascope-XXXXXX").string();
    path_ = ::mkdtemp(pattern.data());
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  ~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path operator/(std::string_view name) const { return path_ / name; }

  std::filesystem::path write(std::string_view name, std::string_view text) const {
    std::ofstream out{path_ / name, std::ios::binary};
    out.write(text.data(), static_cast<std::streamsize>(text.size()));
    return path_ / name;
  }
  template <class Value>
  std::filesystem::path write_values(std::string_view name, std::span<const Value> values) const {
    return write(name, {reinterpret_cast<const char*>(values.data()), values.size_bytes()});
  }

  // How many files lie in it.
  std::ptrdiff_t count() const {
    return std::distance(std::filesystem::directory_iterator{path_}, {});
  }

private:
  std::filesystem::path path_;
};

} // namespace octascope::tests
