#include "pipeline/reconstruction/fft_plan.h"

#include <algorithm>
#include <cstdlib>

namespace octascope::pipeline {

FftBuffer make_fft_buffer(std::size_t floats) {
  FftBuffer buffer{fftwf_alloc_real(floats)};
  std::fill_n(buffer.get(), floats, 0.0F);
  return buffer;
}

FftPlan plan_line_transform(int length, bool complex_input, bool keep_input) {
  const auto floats = 2 * static_cast<std::size_t>(length) + 2; // complex, in and out
  const FftBuffer in = make_fft_buffer(floats);
  const FftBuffer out = make_fft_buffer(floats);
  const std::scoped_lock lock{fft_planner_mutex()};
  // Lines of 512 to 8192 samples are planned in 0.05 to 0.17 s. In a machine whose clock is coarse
  // or slow to ask, planning would go on to any limit, and somebody waits for a picture.
  constexpr double longest_planning_s = 0.25;
  fftwf_set_timelimit(longest_planning_s);
  const unsigned flags = FFTW_MEASURE | (keep_input ? FFTW_PRESERVE_INPUT : FFTW_DESTROY_INPUT);
  return FftPlan{complex_input
                     ? fftwf_plan_dft_1d(length, as_complex(in.get()), as_complex(out.get()),
                                         FFTW_FORWARD, flags)
                     : fftwf_plan_dft_r2c_1d(length, in.get(), as_complex(out.get()), flags)};
}

std::string export_fft_wisdom() {
  const std::scoped_lock lock{fft_planner_mutex()};
  const std::unique_ptr<char, decltype(&std::free)> text{fftwf_export_wisdom_to_string(),
                                                         &std::free};
  return text ? text.get() : "";
}

bool import_fft_wisdom(const std::string& wisdom) {
  const std::scoped_lock lock{fft_planner_mutex()};
  return fftwf_import_wisdom_from_string(wisdom.c_str()) != 0;
}

} // namespace octascope::pipeline
