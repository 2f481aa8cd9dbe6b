// A file that appears complete or not at all.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>

#include "hal/result.h"

namespace octascope::pipeline {

// Who may read a file.
enum class Readers : std::uint8_t {
  as_the_umask_allows,
  owner, // what shows a patient, whatever the umask
};

// Written under a temporary name in the folder of its destination, and renamed by commit(). One
// that is destroyed without a commit leaves nothing behind and the old file, if any, as it was.
// write_at() may be called from several threads at once; the rest from one.
class AtomicFile {
public:
  // ErrorCode::absent: no such folder. ErrorCode::invalid_argument: the destination is a directory,
  // a device or the like.
  static hal::Result<AtomicFile> create(const std::filesystem::path& destination,
                                        Readers readers = Readers::as_the_umask_allows);

  AtomicFile(AtomicFile&& other) noexcept;
  AtomicFile& operator=(AtomicFile&&) = delete;
  ~AtomicFile();

  hal::Result<> write_at(std::uint64_t offset, std::span<const std::byte> bytes) const;

  // To the disk, then under its name, then the name to the disk: a power cut leaves the old file or
  // the new one.
  hal::Result<> commit();

private:
  AtomicFile(int descriptor, std::filesystem::path destination, std::filesystem::path temporary);

  int descriptor_;
  std::filesystem::path destination_;
  std::filesystem::path temporary_;
};

// What was made, renamed or removed under this name survives a power cut. A folder that may be
// written but not read (a drop box) is left to the system.
hal::Result<> sync_folder_of(const std::filesystem::path& file);

// All of a small file, as AtomicFile does it.
hal::Result<> write_atomically(const std::filesystem::path& file, std::string_view text);

} // namespace octascope::pipeline
