#include "pipeline/reconstruction/background.h"

#include <algorithm>
#include <cassert>
#include <limits>
#include <type_traits>
#include <utility>

#include "pipeline/reconstruction/line_kernels.h"

namespace octascope::pipeline {

LineMean::LineMean(int samples)
    : sums_(static_cast<std::size_t>(samples)), mean_(static_cast<std::size_t>(samples)) {}

template <class Count>
void LineMean::measure(const Count* counts, int lines, int right_shift) noexcept {
  const auto samples = static_cast<int>(mean_.size());
  const auto add_all = [&](auto* sums) {
    sum_lines(counts, lines, right_shift, samples, sums);
    for (std::size_t p = 0; p < mean_.size(); ++p)
      mean_[p] = static_cast<double>(sums[p]) / lines;
  };
  if constexpr (std::is_same_v<Count, float>)
    add_all(mean_.data());
  else
    add_all(sums_.data());
}

template void LineMean::measure(const std::uint8_t*, int, int) noexcept;
template void LineMean::measure(const std::uint16_t*, int, int) noexcept;
template void LineMean::measure(const float*, int, int) noexcept;

std::optional<std::string> replace_background_of_few_lines(Calibration& calibration, int a_scans,
                                                           int b_scans) {
  const BackgroundMode given = calibration.background_mode;
  const bool single = a_scans == 1 && b_scans == 1;
  if (single && (given == BackgroundMode::mean || given == BackgroundMode::running)) {
    calibration.background_mode = BackgroundMode::none;
    return "a single line less its own mean is nothing: no background is subtracted, expected more "
           "lines or a recorded one ([background] mode = \"file\")";
  }
  if (a_scans > 1 || given != BackgroundMode::mean)
    return std::nullopt;
  calibration.background_mode = BackgroundMode::running;
  return "B-scans of one A-scan less their own mean are nothing: the mean over several B-scans is "
         "taken instead ([background] mode = \"running\")";
}

RunningBackground::RunningBackground(const SpectrumFormat& format, int a_scans, int sweeps)
    : format_(format), a_scans_(a_scans), window_(std::max(2 * sweeps, 64)),
      stride_(std::max(1, a_scans / 32)), sums_(static_cast<std::size_t>(format.samples)),
      mean_(static_cast<std::size_t>(format.samples)),
      values_(static_cast<std::size_t>(format.samples)) {}

template <class Count>
int RunningBackground::sum_lines_below(const Count* counts, std::uint32_t limit) noexcept {
  std::ranges::fill(sums_, 0.0F);
  int lines = 0;
  for (int a = first_; a < a_scans_; a += stride_) {
    const Count* line = counts + static_cast<std::size_t>(a) * sums_.size();
    lines +=
        add_line_below(line, limit, format_.right_shift, format_.samples, sums_.data()) ? 1 : 0;
  }
  return lines;
}

int RunningBackground::sum_frame_below(std::span<const std::byte> frame,
                                       std::uint32_t limit) noexcept {
  const void* counts = frame.data();
  switch (format_.type) {
  case hal::SampleType::u8: return sum_lines_below(static_cast<const std::uint8_t*>(counts), limit);
  case hal::SampleType::u16:
    return sum_lines_below(static_cast<const std::uint16_t*>(counts), limit);
  case hal::SampleType::f32: break;
  }
  return sum_lines_below(static_cast<const float*>(counts), limit);
}

std::span<const float> RunningBackground::add(std::span<const std::byte> frame) noexcept {
  assert(frame.size() >= format_.line_bytes() * static_cast<std::size_t>(a_scans_));
  int lines = sum_frame_below(frame, format_.full_scale());
  const bool good = lines > 0;
  if (good)
    b_scans_seen_ = std::min(b_scans_seen_ + 1, window_);
  else if (b_scans_seen_ == 0) // nothing better yet; the next good one replaces it
    lines = sum_frame_below(frame, std::numeric_limits<std::uint32_t>::max());
  first_ = (first_ + 1) % stride_;
  if (lines == 0)
    return values_;
  const double share = 1.0 / std::max(1, b_scans_seen_);
  for (std::size_t p = 0; p < mean_.size(); ++p) {
    mean_[p] += share * (static_cast<double>(sums_[p]) / lines - mean_[p]);
    values_[p] = static_cast<float>(mean_[p]);
  }
  return values_;
}

FrameBackgrounds::FrameBackgrounds(RunningBackground running, int samples, int camera_buffers)
    : running_(std::move(running)), samples_(static_cast<std::size_t>(samples)),
      by_buffer_(samples_ * static_cast<std::size_t>(camera_buffers)) {}

void FrameBackgrounds::take(const hal::LineFrame& frame) noexcept {
  const std::size_t start = samples_ * static_cast<std::size_t>(frame.buffer);
  assert(frame.buffer >= 0 && start < by_buffer_.size());
  std::ranges::copy(running_.add(frame.bytes), by_buffer_.data() + start);
}

std::span<const float> FrameBackgrounds::of(const hal::LineFrame& frame) const noexcept {
  return std::span{by_buffer_}.subspan(samples_ * static_cast<std::size_t>(frame.buffer), samples_);
}

} // namespace octascope::pipeline
