// A file that appears complete or not at all.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>

#include "hal/result.h"

namespace octascope::pipeline {

// Written under a temporary name in the folder of its destination, and renamed by commit(). One
// that is destroyed without a commit leaves nothing behind and the old file, if any, as it was.
// write_at() may be called from several threads at once; the rest from one.
class AtomicFile {
public:
  // Fault::absent: no such folder. Fault::invalid_argument: the destination is a directory, a
  // device or the like.
  static hal::Result<AtomicFile> create(const std::filesystem::path& destination);

  AtomicFile(AtomicFile&& other) noexcept;
  AtomicFile& operator=(AtomicFile&&) = delete;
  ~AtomicFile();

  hal::Result<> write_at(std::uint64_t offset, std::span<const std::byte> bytes) const;

  // To the disk, then under its name.
  hal::Result<> commit();

private:
  AtomicFile(int descriptor, std::filesystem::path destination, std::filesystem::path temporary);

  int descriptor_;
  std::filesystem::path destination_;
  std::filesystem::path temporary_;
};

} // namespace octascope::pipeline
