#include "pipeline/scan/downsampled_sweep.h"

#include <algorithm>
#include <cassert>
#include <numeric>

namespace octascope::pipeline {

DownsampledSweep::DownsampledSweep(const ScanPlan& plan)
    : lines_(plan.converted_lines()), depths_(static_cast<std::size_t>(plan.geometry().depths)),
      strokes_(static_cast<std::size_t>(plan.sweeps()) * static_cast<std::size_t>(lines_) * bands),
      came_(static_cast<std::size_t>(plan.sweeps())) {}

void DownsampledSweep::clear() {
  std::ranges::fill(came_, std::uint8_t{0});
}

void DownsampledSweep::draw(int sweep, std::span<const std::uint8_t> levels) noexcept {
  assert(levels.size() >= static_cast<std::size_t>(lines_) * depths_);
  const auto lines = static_cast<std::size_t>(lines_);
  const std::size_t used = std::min<std::size_t>(bands, depths_);
  const std::uint8_t* from = levels.data();
  std::uint8_t* to = strokes_.data() + static_cast<std::size_t>(sweep) * lines * bands;
  for (std::size_t line = 0; line < lines; ++line, from += depths_, to += bands) {
    for (std::size_t band = 0; band < used; ++band) {
      const std::size_t first = band * depths_ / used;
      const std::size_t end = (band + 1) * depths_ / used;
      const auto sum = std::accumulate(from + first, from + end, std::uint32_t{0});
      to[band] = static_cast<std::uint8_t>(sum / static_cast<std::uint32_t>(end - first));
    }
  }
  came_[static_cast<std::size_t>(sweep)] = 1;
}

} // namespace octascope::pipeline
