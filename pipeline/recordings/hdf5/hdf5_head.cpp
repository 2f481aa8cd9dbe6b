#include "pipeline/recordings/hdf5/hdf5_head.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <span>
#include <string_view>
#include <system_error>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>

#include "pipeline/recordings/hdf5/descriptor.h"
#include "pipeline/recordings/hdf5/little_endian.h"

namespace octascope::pipeline {

namespace {

constexpr std::string_view hdf5_signature{"\x89HDF\r\n\x1a\n", 8};

// Offsets in the superblock, and its flags.
constexpr std::size_t version_at = 8, address_size_at = 9, flags_at = 11, end_at = 28;
constexpr std::size_t superblock_bytes = 36;
constexpr unsigned marked_as_written = 1, marked_as_swmr = 4;

// Whether another program holds the file locked against readers, as HDF5's writers do (flock).
bool is_locked(const std::filesystem::path& path) {
  const Descriptor file{::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)};
  return file >= 0 && ::flock(file, LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
}

} // namespace

Hdf5Head read_hdf5_head(const std::filesystem::path& path) {
  Hdf5Head head;
  const Descriptor file{::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)};
  struct stat status = {};
  if (file < 0 || ::fstat(file, &status) != 0)
    return head;
  head.bytes = static_cast<std::uint64_t>(status.st_size);
  std::array<std::byte, superblock_bytes> block{};
  if (::pread(file, block.data(), block.size(), 0) < static_cast<ssize_t>(hdf5_signature.size()))
    return head;
  head.has_signature =
      std::ranges::equal(std::as_bytes(std::span{hdf5_signature}), std::span{block}.first<8>());
  if (!head.has_signature || block[version_at] != std::byte{3} ||
      block[address_size_at] != std::byte{8})
    return head;
  const auto flags = std::to_integer<unsigned>(block[flags_at]);
  head.open_for_writing = (flags & marked_as_written) != 0;
  head.open_for_swmr = (flags & marked_as_swmr) != 0;
  head.whole_bytes = little_endian(std::span{block}.subspan<end_at, 8>());
  return head;
}

hal::Error refusal_of_hdf5(const std::filesystem::path& file, const std::string& reason) {
  using hal::ErrorCode;
  if (is_locked(file))
    return {ErrorCode::busy, "is locked by another program, which has it open to write; expected a "
                             "recording that nobody else changes: close that program"};
  const Hdf5Head head = read_hdf5_head(file);
  if (!head.has_signature)
    return {ErrorCode::bad_data,
            fmt::format("is no recording: found {}, expected a file that octascope record or a "
                        "pedal made",
                        head.bytes == 0 ? "an empty file" : "no HDF5 signature at its beginning")};
  if (head.is_truncated())
    return {ErrorCode::bad_data,
            fmt::format("is truncated: found {} bytes, expected {}, as its beginning says: copy it "
                        "again, or take another copy",
                        head.bytes, head.whole_bytes)};
  if (head.open_for_writing && !head.open_for_swmr)
    return {ErrorCode::busy,
            fmt::format("is marked as open: another program has it open to write, or crashed while "
                        "it had; close that program, or, where there is none, take the mark away "
                        "with `h5clear -s {}` (Debian package hdf5-tools)",
                        file.string())};
  return {ErrorCode::bad_data,
          fmt::format("is damaged: expected a file that octascope record or a pedal made; take "
                      "another copy of it (HDF5 says: {})",
                      reason)};
}

} // namespace octascope::pipeline
