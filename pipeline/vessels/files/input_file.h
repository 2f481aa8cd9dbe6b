// A regular file that is read from front to back, or whole.
//
// Read, not mapped: a file on a medium that is pulled out in the middle gives an error here, and
// would end the program there.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "hal/result.h"

namespace octascope::pipeline {

class InputFile {
public:
  // `expected` completes "found …, expected …". ErrorCode::absent: no such file; invalid_argument:
  // a directory, a pipe or the like; bad_data: it has more than `most_bytes`.
  static hal::Result<InputFile> open(const std::filesystem::path& file, std::string_view expected,
                                     std::uint64_t most_bytes);

  InputFile(InputFile&& other) noexcept;
  InputFile& operator=(InputFile&&) = delete;
  ~InputFile();

  std::uint64_t bytes() const { return bytes_; } // when it was opened

  // Fills as much of `buffer` as there is; less only at the end of the file.
  hal::Result<std::size_t> read(std::span<char> buffer) const;

  // What is left, up to `most` bytes.
  hal::Result<std::string> read_rest(std::uint64_t most) const;

private:
  InputFile(int descriptor, std::filesystem::path file, std::uint64_t bytes)
      : descriptor_(descriptor), file_(std::move(file)), bytes_(bytes) {}

  int descriptor_;
  std::filesystem::path file_;
  std::uint64_t bytes_;
};

} // namespace octascope::pipeline
