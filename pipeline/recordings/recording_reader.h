// Reads recordings, volume by volume; also one that is being written or was never finished.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <vector>

#include "hal/result.h"
#include "pipeline/recordings/recording.h"

namespace octascope::pipeline {

// Bound to one thread at a time.
class RecordingReader {
public:
  // Checks the whole structure, in a process of its own first: HDF5 crashes on some damaged files.
  // ErrorCode::bad_data: no recording, a damaged one, or one of a newer version; busy: another
  // program has locked it, or left it marked as open. The message says what was found and expected.
  static hal::Result<RecordingReader> open(const std::filesystem::path& file);
  RecordingReader(RecordingReader&&) noexcept;
  RecordingReader& operator=(RecordingReader&&) noexcept;
  ~RecordingReader();

  const RecordingFacts& facts() const;
  const RecordingEnd& end() const;

  // In the order in which they were recorded.
  const std::vector<RecordedVolume>& volumes() const;

  // The `n`th, into a volume of the same geometry: levels, states of the B-scans and what the entry
  // tells of the metadata. The occupancy is left alone.
  hal::Result<> read(std::size_t n, Volume& volume);

private:
  struct File;
  explicit RecordingReader(std::unique_ptr<File> file);
  static hal::Result<std::unique_ptr<File>> load(const std::filesystem::path& path);
  static void read_indices(const hal::Result<std::unique_ptr<File>>& opened);

  std::unique_ptr<File> file_;
};

} // namespace octascope::pipeline
