#include "firmware-host/capture/line_averager.h"

namespace octascope::firmware_host {

LineAverager::LineAverager(const pipeline::SpectrumFormat& format, int kept_lines,
                           std::size_t workers, std::uint64_t most_lines)
    : format_(format), kept_lines_(static_cast<std::size_t>(kept_lines)), most_lines_(most_lines),
      sums_(workers, std::vector<std::uint64_t>(static_cast<std::size_t>(format.samples))) {}

void LineAverager::add(std::size_t worker, std::span<const std::byte> frame) noexcept {
  const std::uint64_t before = lines_.fetch_add(kept_lines_, std::memory_order_relaxed);
  if (most_lines_ > 0 && before >= most_lines_) {
    lines_.fetch_sub(kept_lines_, std::memory_order_relaxed);
    return;
  }
  if (format_.type == hal::SampleType::u8)
    add_lines(sums_[worker], reinterpret_cast<const std::uint8_t*>(frame.data()));
  else
    add_lines(sums_[worker], reinterpret_cast<const std::uint16_t*>(frame.data()));
}

template <class Count>
void LineAverager::add_lines(std::vector<std::uint64_t>& sums, const Count* counts) noexcept {
  std::uint64_t saturated = 0;
  for (std::size_t line = 0; line < kept_lines_; ++line, counts += sums.size()) {
    std::uint32_t highest = 0;
    for (std::size_t p = 0; p < sums.size(); ++p) {
      const auto count = static_cast<std::uint32_t>(counts[p] >> format_.right_shift);
      highest = count > highest ? count : highest;
      sums[p] += count;
    }
    if (highest >= format_.full_scale())
      ++saturated;
  }
  saturated_.fetch_add(saturated, std::memory_order_relaxed);
}

std::vector<float> LineAverager::mean() const {
  std::vector<float> mean(static_cast<std::size_t>(format_.samples));
  for (std::size_t p = 0; p < mean.size(); ++p) {
    std::uint64_t sum = 0;
    for (const auto& sums : sums_)
      sum += sums[p];
    mean[p] = static_cast<float>(static_cast<double>(sum) / static_cast<double>(lines()));
  }
  return mean;
}

} // namespace octascope::firmware_host
