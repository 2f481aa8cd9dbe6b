// The format of raw spectra: sample type, significant bits and line length.
#pragma once

#include <cstddef>
#include <cstdint>

#include "hal/line_camera.h"
#include "hal/result.h"
#include "hal/sample_type.h"

namespace octascope::pipeline {

// Little-endian samples, lines without gaps. Shift and full scale do not apply to f32. Cameras of
// 10, 12 or 14 bits are u16 with so many significant bits, shifted where they are left-justified.
struct SpectrumFormat {
  int samples = 1024;
  hal::SampleType type = hal::SampleType::u16;
  int significant_bits = 16; // full scale is 2^significant_bits − 1 after the shift
  int right_shift = 0;

  SpectrumFormat() = default;
  SpectrumFormat(int samples_per_line, hal::SampleType sample_type);
  explicit SpectrumFormat(const hal::LineFormat& line);

  // Bits and shift fit into the type; ErrorCode::invalid_argument with found and expected.
  hal::Result<> validate() const;

  std::size_t line_bytes() const {
    return static_cast<std::size_t>(samples) * bytes_per_sample(type);
  }
  // The highest count after the shift.
  std::uint32_t full_scale() const { return (1U << significant_bits) - 1U; }
};

} // namespace octascope::pipeline
