// Appends frames to a recording of raw spectra.
//
// Frames that were appended and flushed survive a crash of the program and, if the disk keeps what
// it acknowledges, a power cut; hdf5/growing_file.h says how. The attribute `finished` says whether
// it was closed properly.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>

#include "hal/result.h"
#include "pipeline/recordings/raw/raw_recording.h"

namespace octascope::pipeline {

// One thread at a time, but for sync(). Nothing is held in memory: each frame is written when it is
// appended.
class RawWriter {
public:
  // Makes the file, readable by its owner only: it shows a patient. ErrorCode::invalid_argument:
  // the file exists already.
  static hal::Result<RawWriter> create(const std::filesystem::path& file, const RawFacts& facts);
  RawWriter(RawWriter&&) noexcept;
  RawWriter& operator=(RawWriter&&) noexcept;
  // Without finish() the appended frames can be read, and the file is marked as not finished.
  ~RawWriter();

  // `frame` has the format's frame_bytes(); `background` as many values as a line has samples, with
  // RawFacts::has_backgrounds(), else it is not looked at. After an Error nothing more can be
  // appended.
  hal::Result<> append(RawFrame entry, std::span<const std::byte> frame,
                       std::span<const float> background);

  // What was appended so far survives a crash of the program from here on.
  hal::Result<> flush();

  // Any thread, until finish(). To the disk; waits for it. ErrorCode::absent: the file is no longer
  // there under its name.
  hal::Result<> sync();

  // Closes the file and marks it as finished; then as sync().
  hal::Result<> finish(const RawEnd& end);

private:
  struct File;
  explicit RawWriter(std::unique_ptr<File> file);

  std::unique_ptr<File> file_;
};

} // namespace octascope::pipeline
