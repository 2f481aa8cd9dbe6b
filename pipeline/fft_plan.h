// FFTW plans that free themselves, made and freed under one lock.
#pragma once

#include <memory>
#include <mutex>
#include <type_traits>

#include <fftw3.h>

namespace octascope::pipeline {

// FFTW's planner keeps its knowledge in globals of its own, so whoever plans holds this lock;
// executing a plan does not touch them.
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

} // namespace octascope::pipeline
