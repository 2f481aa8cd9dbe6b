// The head of an HDF5 file, read without HDF5, and why HDF5 refuses a file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "hal/result.h"

namespace octascope::pipeline {

// Of a superblock of version 3, as the writer makes it (HDF5 File Format Specification, II.A).
struct Hdf5Head {
  bool has_signature = false;
  // Marked as open by a program that has it open or that crashed; for SWMR, which allows readers.
  bool open_for_writing = false;
  bool open_for_swmr = false;
  std::uint64_t bytes = 0;       // of the file
  std::uint64_t whole_bytes = 0; // that it should have; 0: not known

  bool is_truncated() const { return bytes < whole_bytes; }
};

// If the file cannot be read, everything is false and zero.
Hdf5Head read_hdf5_head(const std::filesystem::path& file);

// Taken from the system and the head, since HDF5's messages differ between versions; only if those
// say nothing, from HDF5's own `reason`. The message does not name the file.
hal::Error refusal_of_hdf5(const std::filesystem::path& file, const std::string& reason);

} // namespace octascope::pipeline
