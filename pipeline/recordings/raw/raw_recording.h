// What a recording of raw spectra holds: facts that are the same for all of it, and one entry for
// each frame.
//
// docs/RECORDINGS.md describes the file (HDF5), for those who read it with other programs.
#pragma once

#include <cstdint>
#include <string>

#include "hal/line_camera.h"
#include "pipeline/calibration/calibration.h"
#include "pipeline/scan/scan_plan.h"
#include "pipeline/volume/eye.h"

namespace octascope::pipeline {

struct RawFacts {
  hal::LineFormat format; // of a frame, with its fly-back; f32 where lines were averaged
  ScanPlan plan;
  int averaged_lines = 0;  // the file holds one line, their mean; 0: lines as they came
  std::string recorded_by; // program and version
  std::string begun;       // local time with its offset, ISO 8601
  std::string source;
  bool simulated = false;
  std::string subject; // empty: not said
  Eye eye = Eye::not_said;
  std::string configuration; // the text in use
  // What turned the frames into levels: with it they become the same levels again, bit for bit on a
  // processor of the same kind.
  Calibration calibration;
  std::string path; // of the reconstruction, "fftw" or "fused"
  std::string isa;  // Reconstructor::isa()

  // With BackgroundMode::running each frame has its own, as it was when the frame came.
  bool has_backgrounds() const {
    return averaged_lines == 0 && calibration.background_mode == BackgroundMode::running;
  }
  // Of each frame, the first.
  int kept_lines() const { return averaged_lines > 0 ? 1 : plan.converted_lines(); }
};

// A frame's history. Times are nanoseconds: of the monotonic clock that stamped the lines, and of
// the wall clock when the frame was taken (since 1970, UTC).
struct RawFrame {
  std::uint64_t volume = 0; // VolumeMetadata::index
  std::int32_t b_scan = 0;
  std::int32_t repeat = 0;
  std::uint64_t sequence = 0; // hal::LineFrame::sequence
  std::int64_t first_line_ns = 0;
  std::int64_t last_line_ns = 0;
  std::int64_t wall_clock_ns = 0;
  double scan_lag_a_scans = 0; // with which its volume is placed
  std::uint32_t crc32 = 0;     // zlib's, of the frame's bytes; the writer fills it in

  bool operator==(const RawFrame&) const = default;
};

// How it ended.
struct RawEnd {
  bool finished = false;      // else power or program was lost; what is there is whole
  std::uint64_t not_kept = 0; // frames that came while it ran and that the disk was too slow for
  std::string camera = {};    // hal::LineCamera::identity(); empty: unknown
};

} // namespace octascope::pipeline
