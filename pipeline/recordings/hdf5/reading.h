// What every reader of our files does, hostile ones among them: docs/RECORDINGS.md.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>

#include "hal/result.h"
#include "pipeline/recordings/hdf5/hdf5.h"

namespace octascope::pipeline {

// None of the messages names the file.

// The file itself, before HDF5 looks at it.
hal::Result<> check_file(const std::filesystem::path& path);

// Also one that is being written or was never finished.
hal::Result<Hdf5Handle> open_hdf5(const std::filesystem::path& path);

// A dataset of a file, or of a group in it: of the class, with dimensions that are `expected` but for
// the first, which is put into `rows`, and claiming no more than its file can hold.
hal::Result<Hdf5Handle> open_dataset(hid_t where, const char* name, H5T_class_t type_class,
                                     std::span<const hsize_t> expected, hsize_t& rows);

// Whether a dataset of records has every number of `expected`, by name.
hal::Result<> check_members(hid_t dataset, const char* name, hid_t expected);

// The bytes of an open file, its holes left out: what is claimed of it takes no more memory than they
// make plausible, however long the file says it is.
std::uint64_t stored_bytes(hid_t file);

// Of what was cut off a file after it was opened HDF5 reads zeros, and no error.
hal::Result<> check_end(hid_t file, std::uint64_t address, std::uint64_t bytes);

// Has HDF5 read the whole index of a dataset's chunks. False: it failed.
bool walk_chunks(hid_t dataset);

struct StoredChunk {
  std::uint64_t address = 0; // in the file
  std::uint64_t bytes = 0;
  unsigned skipped_filters = 0;
};

// The chunk that begins at `offset`, one number for each dimension; empty: there is none. Takes time
// that grows with its number.
std::optional<StoredChunk> find_chunk(hid_t dataset, std::span<const hsize_t> offset);

// From the row `first` on; `size` says how many, and how large they are. False: HDF5 failed.
bool read_rows(hid_t dataset, hid_t type, std::span<const hsize_t> size, hsize_t first, void* rows);

} // namespace octascope::pipeline
