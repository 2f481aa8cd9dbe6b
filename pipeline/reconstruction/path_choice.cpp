#include "pipeline/reconstruction/path_choice.h"

#include <algorithm>
#include <chrono>
#include <limits>

namespace octascope::pipeline {

std::string_view name_of(PathReason reason) {
  switch (reason) {
  case PathReason::asked: return "asked";
  case PathReason::only: return "only";
  case PathReason::measured: return "measured";
  case PathReason::remembered: break;
  }
  return "remembered";
}

PathTimes benchmark_paths(const std::function<void()>& fused, const std::function<void()>& fftw,
                          int lines) {
  using Clock = std::chrono::steady_clock;
  const auto least = [lines](const std::function<void()>& run, double so_far_ns) {
    const auto start = Clock::now();
    run();
    const std::chrono::duration<double, std::nano> taken = Clock::now() - start;
    return std::min(so_far_ns, taken.count() / lines);
  };
  constexpr int rounds = 9;
  constexpr double never = std::numeric_limits<double>::max();
  PathTimes times{never, never};
  for (int round = 0; round < rounds; ++round) {
    times.fused_ns = least(fused, times.fused_ns);
    times.fftw_ns = least(fftw, times.fftw_ns);
  }
  return times;
}

} // namespace octascope::pipeline
