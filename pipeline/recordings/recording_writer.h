// Appends volumes to a recording, as they come.
//
// What was appended and flushed outlives the program and, as far as the disk keeps its word, a
// power cut: the file is one that HDF5 writes for readers who look on (single writer, multiple
// readers), and so is consistent at every moment. It carries its name from the start; `finished` in
// it tells whether it was closed properly.
#pragma once

#include <filesystem>
#include <memory>

#include "hal/result.h"
#include "pipeline/recordings/recording.h"

namespace octascope::pipeline {

// Bound to one thread at a time. Nothing of a recording is held in memory: a volume goes to the
// operating system when it is appended.
class RecordingWriter {
public:
  // Makes the file, readable by its owner alone: it shows a patient. ErrorCode::invalid_argument:
  // there is one of that name already.
  static hal::Result<RecordingWriter> create(const std::filesystem::path& file,
                                             const RecordingFacts& facts);
  RecordingWriter(RecordingWriter&&) noexcept;
  RecordingWriter& operator=(RecordingWriter&&) noexcept;
  // Closes without finish(): what was appended can be read, marked as not finished.
  ~RecordingWriter();

  // Of the facts' geometry. After an Error nothing more can be appended.
  hal::Result<> append(const Volume& volume, const RecordedVolume& entry);

  // To the disk; waits for it.
  hal::Result<> sync();

  // Closes the file and marks it as finished.
  hal::Result<> finish(const RecordingEnd& end);

private:
  struct File;
  explicit RecordingWriter(std::unique_ptr<File> file);

  std::unique_ptr<File> file_;
};

} // namespace octascope::pipeline
