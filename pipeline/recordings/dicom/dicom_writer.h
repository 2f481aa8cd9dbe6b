// Volumes of a recording as DICOM files, for a hospital's archive and its viewers.
//
// Multi-frame Grayscale Byte Secondary Capture Images (PS3.3, A.8.3): one file a volume, one frame
// a B-scan, columns are A-scans, rows are depths. All volumes of a recording are one series of one
// study, whatever else is exported from it, and when. docs/RECORDINGS.md says what is where, and
// which part of the standard has it so.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "hal/result.h"
#include "pipeline/recordings/recording.h"

namespace octascope::pipeline {

// Which levels a viewer shows from black to white, until its user says otherwise.
struct DicomWindow {
  float lowest_db = 0;
  float size_db = 0;
};

struct DicomOptions {
  DicomWindow window;
  std::optional<std::string> patient_id; // another than the recording's subject; empty: none
  std::string exported_by;               // program and version
};

// Bound to one thread.
class DicomWriter {
public:
  // `first` is the recording's first volume: with the facts it tells this recording from any other.
  // ErrorCode::invalid_argument: the subject can be no patient ID. ErrorCode::unsupported: the
  // geometry is larger than a DICOM image may be. ErrorCode::absent: DCMTK's dictionary is not on
  // this machine.
  static hal::Result<DicomWriter> create(const RecordingFacts& facts, const RecordedVolume& first,
                                         const DicomOptions& options);

  // The recording's `n`th volume, from 0, of the facts' geometry. The file appears complete or not
  // at all, readable by its owner alone: it shows a patient.
  hal::Result<> write(const std::filesystem::path& file, const Volume& volume,
                      const RecordedVolume& entry, std::size_t n);

  // A file's size, nearly.
  std::uint64_t file_bytes() const { return facts_.geometry.voxels() + 16384; }

private:
  DicomWriter(RecordingFacts facts, DicomOptions options, std::string name);

  RecordingFacts facts_;
  DicomOptions options_;
  std::string name_; // of the recording, as unique as it is
  std::chrono::minutes offset_from_utc_;
  std::string begun_date_, begun_time_;
  std::string slice_locations_mm_;
  std::vector<std::uint8_t> frames_; // [b][z][a]
};

} // namespace octascope::pipeline
