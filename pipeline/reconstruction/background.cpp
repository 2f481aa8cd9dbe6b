#include "pipeline/reconstruction/background.h"

#include <algorithm>
#include <cassert>
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

RunningBackground::RunningBackground(const SpectrumFormat& format, int a_scans)
    : format_(format), a_scans_(a_scans), b_scan_(format.samples),
      mean_(static_cast<std::size_t>(format.samples)),
      values_(static_cast<std::size_t>(format.samples)) {}

std::span<const float> RunningBackground::add(std::span<const std::byte> frame) noexcept {
  assert(frame.size() >= format_.line_bytes() * static_cast<std::size_t>(a_scans_));
  const auto measure = [&](auto* counts) {
    b_scan_.measure(counts, a_scans_, format_.right_shift);
  };
  switch (format_.type) {
  case hal::SampleType::u8: measure(reinterpret_cast<const std::uint8_t*>(frame.data())); break;
  case hal::SampleType::u16: measure(reinterpret_cast<const std::uint16_t*>(frame.data())); break;
  case hal::SampleType::f32: measure(reinterpret_cast<const float*>(frame.data())); break;
  }
  b_scans_seen_ = std::min(b_scans_seen_ + 1, running_mean_b_scans);
  const double share = 1.0 / b_scans_seen_;
  const std::span<const double> b_scan = b_scan_.values();
  for (std::size_t p = 0; p < mean_.size(); ++p) {
    const double before = b_scans_seen_ == 1 ? 0.0 : mean_[p];
    mean_[p] = before + share * (b_scan[p] - before);
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
