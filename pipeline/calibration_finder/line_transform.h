// Double-precision Fourier transforms for measurements, where speed does not matter.
#pragma once

#include <complex>
#include <memory>
#include <span>

namespace octascope::pipeline {

// A plan and its buffer of `size` values. Use it from one thread at a time. Planning takes the
// planner's lock (fft_plan.h).
class LineTransform {
public:
  enum class Direction { forward, inverse };

  // forward: Σ in[m]·exp(−2πi·km/N); inverse: with +, not divided by N.
  LineTransform(std::size_t size, Direction direction);
  ~LineTransform();
  LineTransform(LineTransform&&) noexcept;
  LineTransform& operator=(LineTransform&&) = delete;

  // In place: fill it, run(), read it.
  std::span<std::complex<double>> values();
  void run();

private:
  struct State;
  std::unique_ptr<State> state_;
};

} // namespace octascope::pipeline
