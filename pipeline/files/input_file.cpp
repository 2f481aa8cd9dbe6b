#include "pipeline/files/input_file.h"

#include <algorithm>
#include <cerrno>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

namespace octascope::pipeline {

namespace fs = std::filesystem;
using hal::ErrorCode;

void MappedFile::Unmap::operator()(const std::byte* bytes) const {
  ::munmap(const_cast<std::byte*>(bytes), size);
}

hal::Result<InputFile> InputFile::open(const fs::path& file, std::string_view expected,
                                       std::uint64_t most_bytes) {
  const auto refuse = [&](ErrorCode fault, std::string_view found) {
    return hal::fail(fault, "{}: {}, expected {}", file.string(), found, expected);
  };
  // Without O_NONBLOCK a pipe would wait here for its writer.
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor < 0)
    return refuse(errno == ENOENT   ? ErrorCode::absent
                  : errno == EACCES ? ErrorCode::denied
                                    : ErrorCode::system,
                  fmt::format("cannot be opened: {}", std::generic_category().message(errno)));
  struct stat status = {};
  const bool known = ::fstat(descriptor, &status) == 0;
  InputFile input{descriptor, file, expected, static_cast<std::uint64_t>(status.st_size)};
  if (!known)
    return refuse(ErrorCode::system, std::generic_category().message(errno));
  if (S_ISDIR(status.st_mode))
    return refuse(ErrorCode::invalid_argument, "is a directory");
  if (!S_ISREG(status.st_mode))
    return refuse(ErrorCode::invalid_argument, "is not a regular file");
  if (input.bytes() > most_bytes)
    return refuse(ErrorCode::bad_data, fmt::format("found {} bytes, more than the limit of {}",
                                                   input.bytes(), most_bytes));
  ::posix_fadvise(descriptor, 0, 0, POSIX_FADV_SEQUENTIAL); // advice: what it answers is no matter
  return input;
}

InputFile::InputFile(InputFile&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)), file_(std::move(other.file_)),
      expected_(std::move(other.expected_)), bytes_(other.bytes_) {}

InputFile::~InputFile() {
  if (descriptor_ >= 0)
    ::close(descriptor_);
}

hal::Result<std::size_t> InputFile::read(std::span<char> buffer) const {
  std::size_t filled = 0;
  while (filled < buffer.size()) {
    const ssize_t got = ::read(descriptor_, buffer.data() + filled, buffer.size() - filled);
    if (got < 0 && errno == EINTR)
      continue;
    if (got < 0)
      return hal::fail(ErrorCode::system, "{}: cannot be read to its end: {}", file_.string(),
                       std::generic_category().message(errno));
    if (got == 0)
      break;
    filled += static_cast<std::size_t>(got);
  }
  return filled;
}

hal::Result<MappedFile> InputFile::map() const {
  void* mapping = ::mmap(nullptr, bytes_, PROT_READ, MAP_PRIVATE, descriptor_, 0);
  if (mapping == MAP_FAILED)
    return hal::fail(ErrorCode::system, "{}: cannot be mapped: {}, expected {}", file_.string(),
                     std::generic_category().message(errno), expected_);
  return MappedFile{{static_cast<const std::byte*>(mapping), bytes_}};
}

hal::Result<std::string> InputFile::read_rest(std::uint64_t most) const {
  std::string text(std::min(bytes_, most), '\0');
  HAL_TRY(auto filled, read(text));
  text.resize(filled);
  return text;
}

} // namespace octascope::pipeline
