#include "pipeline/background.h"

#include <algorithm>
#include <type_traits>

#include "pipeline/line_kernels.h"

namespace octascope::pipeline {

namespace {

// The number of sums to keep: none where the background does not come from the lines.
std::size_t sums(BackgroundMode mode, int samples) {
  const bool measured = mode == BackgroundMode::mean || mode == BackgroundMode::running;
  return measured ? static_cast<std::size_t>(samples) : 0;
}

} // namespace

Background::Background(BackgroundMode mode, int samples, const std::vector<float>& recorded)
    : mode_(mode), samples_(samples), values_(static_cast<std::size_t>(samples)),
      sum_(sums(mode, samples)), float_sum_(sums(mode, samples)) {
  if (mode == BackgroundMode::file)
    values_ = recorded;
}

template <class Count>
void Background::update(std::span<const Count> counts, int lines, int right_shift) noexcept {
  if (sum_.empty())
    return;
  auto& sum = [this]() -> auto& {
    if constexpr (std::is_same_v<Count, float>)
      return float_sum_;
    else
      return sum_;
  }
  ();
  std::fill(sum.begin(), sum.end(), 0);
  const auto stride = static_cast<std::size_t>(samples_);
  for (std::size_t line = 0; line < static_cast<std::size_t>(lines); ++line)
    add_line(counts.data() + line * stride, right_shift, samples_, sum.data());

  b_scans_seen_ =
      mode_ == BackgroundMode::mean ? 1 : std::min(b_scans_seen_ + 1, running_mean_b_scans);
  const double share = 1.0 / b_scans_seen_;
  for (std::size_t p = 0; p < stride; ++p) {
    const double before = b_scans_seen_ == 1 ? 0.0 : static_cast<double>(values_[p]);
    values_[p] =
        static_cast<float>(before + share * (static_cast<double>(sum[p]) / lines - before));
  }
}

template void Background::update(std::span<const std::uint8_t>, int, int) noexcept;
template void Background::update(std::span<const std::uint16_t>, int, int) noexcept;
template void Background::update(std::span<const float>, int, int) noexcept;

} // namespace octascope::pipeline
