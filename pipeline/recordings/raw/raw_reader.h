// Reads recordings of raw spectra; also one that is being written or was never finished.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <vector>

#include "hal/result.h"
#include "pipeline/reconstruction/spectra_file.h"
#include "pipeline/recordings/raw/raw_recording.h"

namespace octascope::pipeline {

// Whether it is an HDF5 file: no other spectra are. What kind of one, RawReader::open() says.
bool is_raw_recording(const std::filesystem::path& file);

// Whether its attribute `format` says that it is one; a file that cannot be read says nothing.
bool says_raw_spectra(const std::filesystem::path& file);

// Frames of one volume that were kept.
struct RawVolume {
  std::uint64_t index = 0; // VolumeMetadata::index
  std::size_t first = 0;   // of RawReader::frames()
  std::size_t count = 0;
  bool whole = false; // every sweep is there, in order
};

enum class RawLines : std::uint8_t { kept, all };

// Bound to one thread at a time.
class RawReader {
public:
  // Checks the whole structure, in a process of its own first: HDF5 crashes on some damaged files.
  // ErrorCode::bad_data: no raw spectra, a damaged file, or one of a newer version; busy: another
  // program has locked it, or left it marked as open. The message says what was found and expected.
  static hal::Result<RawReader> open(const std::filesystem::path& file);
  RawReader(RawReader&&) noexcept;
  RawReader& operator=(RawReader&&) noexcept;
  ~RawReader();

  const RawFacts& facts() const;
  const RawEnd& end() const;

  // In the order of volumes, B-scans and repeats, whatever that of the file is.
  const std::vector<RawFrame>& frames() const;
  const std::vector<RawVolume>& volumes() const;

  // ErrorCode::invalid_argument: there is no such volume, or it is not whole.
  hal::Result<RawVolume> whole_volume(std::size_t n) const;
  // The first of them. ErrorCode::bad_data: none is whole.
  hal::Result<RawVolume> first_whole_volume() const;

  // So many frames, where they lie in the file, one sweep each. ErrorCode::bad_data: the file is
  // damaged, or another program packed it.
  hal::Result<SpectraFile> spectra(std::size_t first, std::size_t count, RawLines lines) const;
  // Their running backgrounds, [frame][sample]; nothing without RawFacts::has_backgrounds().
  hal::Result<std::vector<float>> backgrounds(std::size_t first, std::size_t count) const;

private:
  struct File;
  explicit RawReader(std::unique_ptr<File> file);
  static hal::Result<std::unique_ptr<File>> load(const std::filesystem::path& path);
  static void read_indices(const hal::Result<std::unique_ptr<File>>& opened);

  std::unique_ptr<File> file_;
};

} // namespace octascope::pipeline
