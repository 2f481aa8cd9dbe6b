// FFTW plans that free themselves, made and freed under one lock, and the planner's wisdom.
#pragma once

#include <cstddef>
#include <memory>
#include <mutex>
#include <string>
#include <type_traits>

#include <fftw3.h>

namespace octascope::pipeline {

// FFTW's planner uses globals, so planning needs this lock; executing a plan does not.
inline std::mutex& fft_planner_mutex() {
  static std::mutex mutex;
  return mutex;
}

struct DestroyFftPlan {
  void operator()(fftwf_plan plan) const {
    const std::scoped_lock lock{fft_planner_mutex()};
    fftwf_destroy_plan(plan);
  }
};
using FftPlan = std::unique_ptr<std::remove_pointer_t<fftwf_plan>, DestroyFftPlan>;

struct FreeFftBuffer {
  void operator()(float* memory) const { fftwf_free(memory); }
};
using FftBuffer = std::unique_ptr<float[], FreeFftBuffer>;

// Zeroed, aligned as FFTW's fastest code wants it.
FftBuffer make_fft_buffer(std::size_t floats);

inline fftwf_complex* as_complex(float* floats) {
  return reinterpret_cast<fftwf_complex*>(floats);
}

// A forward transform of one line out of place, for buffers of make_fft_buffer(): complex → all
// bins, or real → bins 0 … length/2. With `keep_input` the input is the same afterwards. Measures
// candidates, for a second at most, unless wisdom knows the answer. nullptr: FFTW has no plan.
FftPlan plan_line_transform(int length, bool complex_input, bool keep_input);

// The planner's wisdom as text, for later runs. Import returns false and changes nothing where the
// text is damaged or from another FFTW.
std::string export_fft_wisdom();
bool import_fft_wisdom(const std::string& wisdom);

} // namespace octascope::pipeline
