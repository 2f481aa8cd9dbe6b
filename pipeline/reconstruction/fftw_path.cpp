#include "pipeline/reconstruction/fftw_path.h"

#include <algorithm>
#include <cmath>
#include <complex>

namespace octascope::pipeline {

namespace {

std::size_t padded(int samples) {
  return (static_cast<std::size_t>(samples) + 7) / 8 * 8;
}

// Window, dispersion phase and the 1/N of the level, folded. The padding is 0.
std::vector<float> make_factors(const Calibration& calibration) {
  const bool complex_factors = !calibration.dispersion_rad.empty();
  std::vector<float> factors(padded(calibration.samples) * (complex_factors ? 2 : 1));
  for (std::size_t m = 0; m < calibration.window.size(); ++m) {
    const double weight = calibration.window[m] / calibration.samples;
    if (complex_factors) {
      factors[2 * m] = static_cast<float>(weight * std::cos(calibration.dispersion_rad[m]));
      factors[2 * m + 1] = static_cast<float>(weight * std::sin(calibration.dispersion_rad[m]));
    } else {
      factors[m] = static_cast<float>(weight);
    }
  }
  return factors;
}

void write_levels(const float* bins, int depths, std::uint8_t* levels) {
  levels_u8(bins, depths, levels);
}
void write_levels(const float* bins, int depths, float* levels) {
  levels_db(bins, depths, levels);
}
void write_levels(const float* bins, int depths, const BinsAndLevels& both) {
  levels_u8(bins, depths, both.levels);
  std::transform(reinterpret_cast<const std::complex<float>*>(bins),
                 reinterpret_cast<const std::complex<float>*>(bins) + depths, both.bins,
                 &PackedBin::of);
}

// The line is read after the transform of the one before it; until then it comes to the cache.
template <class Count> void fetch(const Count* line, int samples) {
  constexpr int apart = 64 / static_cast<int>(sizeof(Count));
  for (int p = 0; p < samples; p += apart)
    __builtin_prefetch(line + p);
}

} // namespace

hal::Result<FftwPath> FftwPath::make(const Calibration& calibration, const SpectrumFormat& format,
                                     int a_scans) {
  FftwPath path;
  path.format_ = format;
  path.a_scans_ = a_scans;
  path.depths_ = calibration.depths();
  path.length_ = calibration.samples * calibration.zero_padding;
  path.fixed_pattern_ = calibration.fixed_pattern;
  path.taps_ = make_resampling_taps(calibration.positions, calibration.interpolation);
  path.factors_ = make_factors(calibration);
  path.complex_input_ = !calibration.dispersion_rad.empty();
  path.shape_line_ = shape_line_kernel(path.taps_.width, path.complex_input_);
  // The zeros behind a padded line must survive the transform.
  const bool keep_input = calibration.zero_padding > 1;
  path.transform_ = plan_line_transform(path.length_, path.complex_input_, keep_input);
  if (!path.transform_)
    return hal::fail(hal::ErrorCode::system, "reconstruction: FFTW has no plan for {} samples",
                     path.length_);
  return path;
}

FftwPath::Buffers FftwPath::make_buffers() const {
  // Two floats a sample serve both transforms, in and out.
  const std::size_t complex_line = 2 * padded(length_);
  Buffers buffers{make_fft_buffer(padded(format_.samples)), make_fft_buffer(complex_line),
                  make_fft_buffer(complex_line + 2), std::nullopt};
  if (fixed_pattern_.mode == FixedPatternMode::minimum_variance)
    buffers.fixed_pattern.emplace(fixed_pattern_.segments, a_scans_, depths_);
  return buffers;
}

void FftwPath::transform_line(Buffers& buffers) const noexcept {
  shape_line_(buffers.line.get(), taps_.first.data(), taps_.weights.data(), factors_.data(),
              format_.samples, buffers.shaped.get());
  if (complex_input_)
    fftwf_execute_dft(transform_.get(), as_complex(buffers.shaped.get()),
                      as_complex(buffers.bins.get()));
  else
    fftwf_execute_dft_r2c(transform_.get(), buffers.shaped.get(), as_complex(buffers.bins.get()));
}

template <class Count, class Levels>
int FftwPath::reconstruct(const Count* counts, int lines, const float* background, Buffers& buffers,
                          Levels levels, std::uint8_t* saturated) const noexcept {
  const std::uint32_t full_scale = format_.full_scale();
  const auto at = [&](int a) { return levels + std::ptrdiff_t{a} * depths_; };
  int saturated_lines = 0;
  for (int a = 0; a < lines; ++a) {
    const Count* const line = counts + std::ptrdiff_t{a} * format_.samples;
    const std::uint32_t highest =
        load_line(line, background, format_.right_shift, format_.samples, buffers.line.get());
    saturated[a] = highest >= full_scale ? 1 : 0;
    saturated_lines += saturated[a];
    if (a + 1 < lines)
      fetch(line + format_.samples, format_.samples);
    transform_line(buffers);
    if (buffers.fixed_pattern)
      std::copy_n(buffers.bins.get(), 2 * depths_, buffers.fixed_pattern->a_scan(a));
    else
      write_levels(buffers.bins.get(), depths_, at(a));
  }
  if (buffers.fixed_pattern) {
    buffers.fixed_pattern->remove(lines);
    for (int a = 0; a < lines; ++a)
      write_levels(buffers.fixed_pattern->a_scan(a), depths_, at(a));
  }
  return saturated_lines;
}

template int FftwPath::reconstruct(const std::uint8_t*, int, const float*, Buffers&, std::uint8_t*,
                                   std::uint8_t*) const noexcept;
template int FftwPath::reconstruct(const std::uint8_t*, int, const float*, Buffers&, float*,
                                   std::uint8_t*) const noexcept;
template int FftwPath::reconstruct(const std::uint8_t*, int, const float*, Buffers&, BinsAndLevels,
                                   std::uint8_t*) const noexcept;
template int FftwPath::reconstruct(const std::uint16_t*, int, const float*, Buffers&, std::uint8_t*,
                                   std::uint8_t*) const noexcept;
template int FftwPath::reconstruct(const std::uint16_t*, int, const float*, Buffers&, float*,
                                   std::uint8_t*) const noexcept;
template int FftwPath::reconstruct(const std::uint16_t*, int, const float*, Buffers&, BinsAndLevels,
                                   std::uint8_t*) const noexcept;
template int FftwPath::reconstruct(const float*, int, const float*, Buffers&, std::uint8_t*,
                                   std::uint8_t*) const noexcept;
template int FftwPath::reconstruct(const float*, int, const float*, Buffers&, float*,
                                   std::uint8_t*) const noexcept;
template int FftwPath::reconstruct(const float*, int, const float*, Buffers&, BinsAndLevels,
                                   std::uint8_t*) const noexcept;

} // namespace octascope::pipeline
