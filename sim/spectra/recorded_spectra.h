// Plays a recording of raw spectra in an endless loop, as if a camera delivered it.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "hal/result.h"
#include "sim/spectra/spectra_source.h"

namespace octascope::sim {

// One volume of raw spectra in the order [sweep][line][sample] (for a plain scan: B-scan and
// A-scan), counts in the machine's (little-endian) byte order. The caller opens the file;
// `keep_alive` owns the memory of `samples`.
struct SpectraRecording {
  std::span<const std::byte> samples;
  // Instead of `samples`: sweeps that lie apart, each of a_scans lines, of one volume or several
  // after each other.
  std::vector<std::span<const std::byte>> sweeps = {};
  hal::SampleType type = hal::SampleType::u16; // u8 or u16
  int b_scans = 0;
  int a_scans = 0;
  int samples_per_line = 0;
  int significant_bits = 16;
  int right_shift = 0;
  std::string name; // of the file, for display
  std::shared_ptr<const void> keep_alive;
};

class RecordedSpectra final : public SpectraSource {
public:
  // A recording has no fly-back. With fly_back_lines > 0, that many lines are appended to each
  // frame, taken from its A-scans in reverse order, as the returning beam would meet them. This
  // costs a copy of the recording; otherwise its samples are used in place.
  // ErrorCode::invalid_argument: the counts do not match the number of samples.
  static hal::Result<std::unique_ptr<RecordedSpectra>> make(SpectraRecording recording,
                                                            int fly_back_lines = 0);

  const hal::LineFormat& format() const override { return format_; }
  int sweeps() const override { return recording_.b_scans; }
  std::span<const std::byte> frame(std::uint64_t volume, int b_scan) const override;
  std::string description() const override;

private:
  RecordedSpectra(SpectraRecording recording, int fly_back_lines);
  void add_fly_back(int fly_back_lines);
  void split(std::span<const std::byte> frames);

  SpectraRecording recording_; // its `sweeps` are the frames that are played
  hal::LineFormat format_;
  std::vector<std::byte> with_fly_back_; // empty if there is none
};

} // namespace octascope::sim
