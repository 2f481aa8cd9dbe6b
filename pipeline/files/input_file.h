// A regular file that is read from front to back, read whole, or mapped.
//
// If the medium is removed meanwhile, reading returns an error, but accessing a mapped file ends
// the program.
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

// The bytes of a mapped file, valid as long as this object.
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
  // `expected` completes messages like "found …, expected …". ErrorCode::absent: no such file;
  // denied: no permission; invalid_argument: a directory, a pipe or the like; bad_data: more than
  // `most_bytes`.
  static hal::Result<InputFile> open(const std::filesystem::path& file, std::string_view expected,
                                     std::uint64_t most_bytes);

  InputFile(InputFile&& other) noexcept;
  InputFile& operator=(InputFile&&) = delete;
  ~InputFile();

  std::uint64_t bytes() const { return bytes_; } // size when it was opened

  // Fills `buffer` and returns the bytes read, fewer than its size only at the end of the file.
  hal::Result<std::size_t> read(std::span<char> buffer) const;

  // Maps the whole file, which must not be empty.
  hal::Result<MappedFile> map() const;

  // Reads the remainder, up to `most` bytes.
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
