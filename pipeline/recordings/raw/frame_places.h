// Where the frames of a recording of raw spectra lie in its file.
//
// HDF5 looks for a chunk in a time that grows with its number: for the many frames of a recording
// with small ones, minutes. The recorder puts one behind the other, with its index between them now and then; so
// a small frame is looked for behind the one before, where its checksum tells it, and HDF5 is asked
// for what is not found so.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>

#include "hal/result.h"
#include "pipeline/files/input_file.h"
#include "pipeline/recordings/hdf5/hdf5.h"

namespace octascope::pipeline {

// Bound to one thread.
class FramePlaces {
public:
  // `spectra`, whose frames are unpacked, one a chunk, outlives this. Errors as of InputFile.
  static hal::Result<FramePlaces> open(const std::filesystem::path& file, hid_t spectra,
                                       std::size_t frame_bytes);

  // The frame in row `row`, whose checksum should be that. Quick where rows are asked for in their
  // order. Empty: there is none, or one of another size.
  std::optional<std::uint64_t> find(std::size_t row, std::uint32_t crc32);

  std::size_t asked() const { return asked_; } // HDF5, how often

private:
  FramePlaces(MappedFile mapped, hid_t spectra, std::size_t frame_bytes)
      : mapped_(std::move(mapped)), spectra_(spectra), frame_bytes_(frame_bytes) {}

  bool is_at(std::uint64_t place, std::uint32_t crc32) const;
  std::optional<std::uint64_t> ask_hdf5(std::size_t row);

  struct Found {
    std::size_t row;
    std::uint64_t place;
  };
  std::optional<std::uint64_t> find_behind(const Found& last, std::size_t row,
                                           std::uint32_t crc32) const;

  MappedFile mapped_;
  hid_t spectra_;
  std::size_t frame_bytes_;
  std::optional<Found> last_;
  int misses_ = 0; // running, behind the last
  std::size_t asked_ = 0;
};

} // namespace octascope::pipeline
