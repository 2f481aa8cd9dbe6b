// The FFTW path of the reconstruction: whole B-scans, line by line, in separate readable steps.
//
// It takes any number of samples and every type, and alone does what needs the complex A-scans or
// a longer transform: removal of the fixed pattern, zero-padding.
#pragma once

#include <optional>
#include <vector>

#include "hal/result.h"
#include "pipeline/calibration/calibration.h"
#include "pipeline/calibration/fixed_pattern.h"
#include "pipeline/calibration/k_linearisation.h"
#include "pipeline/reconstruction/fft_plan.h"
#include "pipeline/reconstruction/line_kernels.h"
#include "pipeline/reconstruction/spectrum_format.h"
#include "pipeline/volume/packed_bin.h"

namespace octascope::pipeline {

// Immutable once made; serves any number of threads, each with Buffers of its own.
class FftwPath {
public:
  // What one worker writes to.
  struct Buffers {
    FftBuffer line;   // counts without background
    FftBuffer shaped; // input of the transform; its padding stays 0
    FftBuffer bins;   // its output, complex
    std::optional<FixedPatternRemover> fixed_pattern;
  };

  // `calibration` and `format` are valid and fit together. ErrorCode::system where FFTW has no
  // plan.
  static hal::Result<FftwPath> make(const Calibration& calibration, const SpectrumFormat& format,
                                    int a_scans);

  Buffers make_buffers() const;

  // Lines without gaps → levels, calibration.depths() each. `background` has N values in counts
  // after the shift. `saturated`: by line, whether a count is at full scale; returns the number of
  // such lines. Count: std::uint8_t, std::uint16_t or float; Levels: std::uint8_t*, float* (dB)
  // or BinsAndLevels.
  template <class Count, class Levels>
  int reconstruct(const Count* counts, int lines, const float* background, Buffers& buffers,
                  Levels levels, std::uint8_t* saturated) const noexcept;

private:
  FftwPath() = default;
  void transform_line(Buffers& buffers) const noexcept;

  SpectrumFormat format_;
  int a_scans_ = 0;
  int depths_ = 0;
  int length_ = 0; // of the transform
  FixedPatternRemoval fixed_pattern_;
  ResamplingTaps taps_;
  std::vector<float> factors_;
  bool complex_input_ = false;
  ShapeLine shape_line_ = nullptr;
  FftPlan transform_;
};

} // namespace octascope::pipeline
