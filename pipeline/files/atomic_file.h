// A file that appears complete or not at all.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>

#include "hal/result.h"

namespace octascope::pipeline {

enum class Readers : std::uint8_t {
  as_the_umask_allows,
  owner, // for patient data: only the owner, whatever the umask
};

// Written under a temporary name in the folder of its destination and renamed by commit(). Without
// a commit(), the destructor removes the temporary file, and the old file, if any, is unchanged.
// write_at() may be called from several threads at once, the rest from one.
class AtomicFile {
public:
  // If `destination` is a symbolic link, the file it points to is replaced. ErrorCode::absent: no
  // such folder. ErrorCode::denied: the folder cannot be written. ErrorCode::invalid_argument: the
  // destination is a directory, a device or the like.
  static hal::Result<AtomicFile> create(const std::filesystem::path& destination,
                                        Readers readers = Readers::as_the_umask_allows);

  AtomicFile(AtomicFile&& other) noexcept;
  AtomicFile& operator=(AtomicFile&&) = delete;
  ~AtomicFile();

  hal::Result<> write_at(std::uint64_t offset, std::span<const std::byte> bytes) const;

  // Flushes the data to disk, renames the file and flushes the folder: after a power cut there is
  // either the old file or the new one.
  hal::Result<> commit();

private:
  AtomicFile(int descriptor, std::filesystem::path destination, std::filesystem::path temporary);

  int descriptor_;
  std::filesystem::path destination_;
  std::filesystem::path temporary_;
};

// Flushes the folder of `file`, so that creating, renaming or removing the file survives a power
// cut. Does nothing for a folder that may be written but not read (a drop box).
hal::Result<> sync_folder_of(const std::filesystem::path& file);

// Writes a whole small file through an AtomicFile.
hal::Result<> write_atomically(const std::filesystem::path& file, std::string_view text);

} // namespace octascope::pipeline
