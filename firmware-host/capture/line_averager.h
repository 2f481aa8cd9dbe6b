// The mean of many lines, made by the workers while the frames are theirs.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "pipeline/reconstruction/spectrum_format.h"

namespace octascope::firmware_host {

class LineAverager {
public:
  // `most_lines`: frames that come after so many are left out; 0: none is.
  LineAverager(const pipeline::SpectrumFormat& format, int kept_lines, std::size_t workers,
               std::uint64_t most_lines);

  // Worker `worker`: adds the kept lines of a frame. Neither waits nor allocates.
  void add(std::size_t worker, std::span<const std::byte> frame) noexcept;

  // Any thread.
  std::uint64_t lines() const { return lines_.load(std::memory_order_relaxed); }
  std::uint64_t saturated_lines() const { return saturated_.load(std::memory_order_relaxed); }

  // After the last add(): counts after the right shift, as many as a line has samples. At least one
  // line was added.
  std::vector<float> mean() const;

private:
  template <class Count>
  void add_lines(std::vector<std::uint64_t>& sums, const Count* counts) noexcept;

  pipeline::SpectrumFormat format_;
  std::size_t kept_lines_;
  std::uint64_t most_lines_;
  std::vector<std::vector<std::uint64_t>> sums_; // by worker
  std::atomic<std::uint64_t> lines_{0};
  std::atomic<std::uint64_t> saturated_{0};
};

} // namespace octascope::firmware_host
