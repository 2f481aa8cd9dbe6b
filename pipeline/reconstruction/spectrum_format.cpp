#include "pipeline/reconstruction/spectrum_format.h"

namespace octascope::pipeline {

SpectrumFormat::SpectrumFormat(int samples_per_line, hal::SampleType sample_type)
    : samples(samples_per_line), type(sample_type),
      significant_bits(sample_type == hal::SampleType::u8 ? 8 : 16) {}

SpectrumFormat::SpectrumFormat(const hal::LineFormat& line)
    : samples(line.samples_per_line), type(line.sample_type),
      significant_bits(line.significant_bits), right_shift(line.right_shift) {}

hal::Result<> SpectrumFormat::validate() const {
  const int bits = type == hal::SampleType::u8 ? 8 : 16;
  if (significant_bits >= 1 && right_shift >= 0 && right_shift < bits &&
      significant_bits + right_shift <= bits)
    return {};
  return hal::fail(hal::ErrorCode::invalid_argument,
                   "significant_bits {} and right_shift {} do not fit into {} bits",
                   significant_bits, right_shift, bits);
}

} // namespace octascope::pipeline
