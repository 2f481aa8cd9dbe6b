#include "pipeline/calibration_finder/line_transform.h"

#include <mutex>
#include <vector>

#include <fftw3.h>

#include "pipeline/reconstruction/fft_plan.h"

namespace octascope::pipeline {

struct LineTransform::State {
  std::vector<std::complex<double>> values;
  fftw_plan plan = nullptr;

  State(std::size_t size, int sign) : values(size) {
    auto* data = reinterpret_cast<fftw_complex*>(values.data());
    const std::scoped_lock lock{fft_planner_mutex()};
    plan = fftw_plan_dft_1d(static_cast<int>(size), data, data, sign, FFTW_ESTIMATE);
  }
  State(const State&) = delete;
  State& operator=(const State&) = delete;
  ~State() {
    const std::scoped_lock lock{fft_planner_mutex()};
    fftw_destroy_plan(plan);
  }
};

LineTransform::LineTransform(std::size_t size, Direction direction)
    : state_(std::make_unique<State>(size, direction == Direction::forward ? FFTW_FORWARD
                                                                           : FFTW_BACKWARD)) {}
LineTransform::~LineTransform() = default;
LineTransform::LineTransform(LineTransform&&) noexcept = default;

std::span<std::complex<double>> LineTransform::values() {
  return state_->values;
}
void LineTransform::run() {
  fftw_execute(state_->plan);
}

} // namespace octascope::pipeline
