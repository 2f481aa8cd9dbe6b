// Appends volumes to a recording.
//
// Volumes that were appended and flushed survive a crash of the program and, if the disk keeps what
// it acknowledges, a power cut: the file is written with HDF5's single-writer-multiple-readers mode
// and is consistent at every moment. It has its final name from the start; its attribute `finished`
// says whether it was closed properly.
#pragma once

#include <filesystem>
#include <memory>

#include "hal/result.h"
#include "pipeline/recordings/recording.h"

namespace octascope::pipeline {

// One thread at a time. No volume is held in memory: each is written when it is appended.
class RecordingWriter {
public:
  // Makes the file, readable by its owner only: it shows a patient. ErrorCode::invalid_argument:
  // the file exists already.
  static hal::Result<RecordingWriter> create(const std::filesystem::path& file,
                                             const RecordingFacts& facts);
  RecordingWriter(RecordingWriter&&) noexcept;
  RecordingWriter& operator=(RecordingWriter&&) noexcept;
  // Without finish() the appended volumes can be read, and the file is marked as not finished.
  ~RecordingWriter();

  // Of the facts' geometry. After an Error nothing more can be appended.
  hal::Result<> append(const Volume& volume, const RecordedVolume& entry);

  // To the disk; waits for it. ErrorCode::absent: the file is no longer there under its name.
  hal::Result<> sync();

  // Closes the file and marks it as finished; then as sync().
  hal::Result<> finish(const RecordingEnd& end);

private:
  struct File;
  explicit RecordingWriter(std::unique_ptr<File> file);

  std::unique_ptr<File> file_;
};

} // namespace octascope::pipeline
