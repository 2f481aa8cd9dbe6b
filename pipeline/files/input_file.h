// A regular file that is read from front to back, read whole, or mapped.
//
// A file on a medium that is pulled out in the middle gives an error where it is read, and ends the
// program where it is mapped.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "hal/result.h"

namespace octascope::pipeline {

// A mapped file's bytes, for as long as this lives.
class MappedFile {
public:
  explicit MappedFile(std::span<const std::byte> bytes)
      : bytes_{bytes.data(), Unmap{bytes.size()}} {}

  std::span<const std::byte> bytes() const { return {bytes_.get(), bytes_.get_deleter().size}; }

private:
  struct Unmap {
    std::size_t size;
    void operator()(const std::byte* bytes) const;
  };
  std::unique_ptr<const std::byte[], Unmap> bytes_;
};

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

  // All of it, which must not be nothing.
  hal::Result<MappedFile> map() const;

  // What is left, up to `most` bytes.
  hal::Result<std::string> read_rest(std::uint64_t most) const;

private:
  InputFile(int descriptor, std::filesystem::path file, std::string_view expected,
            std::uint64_t bytes)
      : descriptor_(descriptor), file_(std::move(file)), expected_(expected), bytes_(bytes) {}

  int descriptor_;
  std::filesystem::path file_;
  std::string expected_;
  std::uint64_t bytes_;
};

} // namespace octascope::pipeline
