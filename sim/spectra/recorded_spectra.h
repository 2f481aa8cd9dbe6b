// A recording of raw spectra, played in a loop as if a camera delivered it.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "hal/result.h"
#include "sim/spectra/spectra_source.h"

namespace octascope::sim {

// One volume of raw spectra in the order [sweep][line][sample] (B-scan and A-scan, in a plain
// scan), 16-bit counts in the machine's (little-endian) order. The caller opens the file;
// `keep_alive` owns the memory of `samples`.
struct SpectraRecording {
  std::span<const std::uint16_t> samples;
  int b_scans = 0;
  int a_scans = 0;
  int samples_per_line = 0;
  int significant_bits = 16;
  std::string name; // of the file, for people
  std::shared_ptr<const void> keep_alive;
};

class RecordedSpectra final : public SpectraSource {
public:
  // A recording has no fly-back. With fly_back_lines > 0 each frame gets that many lines after its
  // A-scans, taken from these backwards as the returning beam would see them; this copies the
  // recording, which is otherwise used in place. ErrorCode::invalid_argument: counts and the number
  // of samples do not match.
  static hal::Result<std::unique_ptr<RecordedSpectra>> make(SpectraRecording recording,
                                                            int fly_back_lines = 0);

  const hal::LineFormat& format() const override { return format_; }
  int sweeps() const override { return recording_.b_scans; }
  std::span<const std::byte> frame(std::uint64_t volume, int b_scan) const override;
  std::string description() const override;

private:
  RecordedSpectra(SpectraRecording recording, int fly_back_lines);
  void add_fly_back(int fly_back_lines);

  SpectraRecording recording_;
  hal::LineFormat format_;
  std::vector<std::uint16_t> with_fly_back_;     // empty without fly-back
  std::span<const std::uint16_t> frame_samples_; // all frames, one after the other
};

} // namespace octascope::sim
