#include "pipeline/acquisition/b_scan_builder.h"

#include <algorithm>

#include "pipeline/threads/cpu_clones.h"

namespace octascope::pipeline {

namespace {

// One function a number of repeats, in 16 bits: with the number open it took ten times as long.
OCTASCOPE_CPU_CLONES
void average_two(const std::uint8_t* repeats, std::size_t size, std::uint8_t* __restrict result) {
  for (std::size_t i = 0; i < size; ++i)
    result[i] = static_cast<std::uint8_t>((repeats[i] + repeats[size + i] + 1) >> 1);
}

// Multiplying by a third in 16-bit fixed point, rounded up, divides sums of so few bytes exactly.
OCTASCOPE_CPU_CLONES
void average_three(const std::uint8_t* repeats, std::size_t size, std::uint8_t* __restrict result) {
  constexpr std::uint32_t third = 21846;
  for (std::size_t i = 0; i < size; ++i) {
    const auto sum =
        static_cast<std::uint16_t>(repeats[i] + repeats[size + i] + repeats[2 * size + i] + 1);
    result[i] = static_cast<std::uint8_t>(sum * third >> 16U);
  }
}

OCTASCOPE_CPU_CLONES
void average_four(const std::uint8_t* repeats, std::size_t size, std::uint8_t* __restrict result) {
  for (std::size_t i = 0; i < size; ++i)
    result[i] = static_cast<std::uint8_t>(
        (repeats[i] + repeats[size + i] + repeats[2 * size + i] + repeats[3 * size + i] + 2) >> 2);
}

} // namespace

void average_repeats(std::span<const std::uint8_t> repeats, int count,
                     std::span<std::uint8_t> result) {
  static_assert(ScanPlan::most_repeats == 4);
  if (count == 1)
    std::copy_n(repeats.begin(), result.size(), result.begin());
  else if (count == 2)
    average_two(repeats.data(), result.size(), result.data());
  else if (count == 3)
    average_three(repeats.data(), result.size(), result.data());
  else
    average_four(repeats.data(), result.size(), result.data());
}

BScanBuilder::BScanBuilder(const ScanPlan& plan, std::size_t workers, ReconstructSweep reconstruct,
                           std::optional<RepeatComparison> comparison)
    : plan_(plan), reconstruct_(std::move(reconstruct)), comparison_(std::move(comparison)),
      buffers_(workers) {
  const VolumeGeometry geometry = plan.geometry();
  for (Buffers& buffers : buffers_) {
    if (plan.bidirectional)
      buffers.lines.resize(static_cast<std::size_t>(plan.converted_lines()) *
                           static_cast<std::size_t>(geometry.depths));
    if (plan.repeats > 1)
      buffers.repeats.resize(static_cast<std::size_t>(plan.repeats) * geometry.b_scan_voxels());
  }
}

int BScanBuilder::build(std::size_t worker, int b_scan, std::span<const hal::LineFrame> frames,
                        const SweepAlignment& alignment, DownsampledSweep* sketch,
                        std::span<std::uint8_t> levels) {
  const auto came = std::ranges::count_if(frames, [](const auto& f) { return f.buffer >= 0; });
  const std::span repeats{buffers_[worker].repeats};
  if (comparison_)
    comparison_->begin(worker);
  int saturated = 0;
  std::size_t done = 0;
  for (std::size_t repeat = 0; repeat < frames.size(); ++repeat) {
    if (frames[repeat].buffer < 0)
      continue;
    const int sweep = b_scan * plan_.repeats + static_cast<int>(repeat);
    const auto out = came == 1 ? levels : repeats.subspan(done * levels.size(), levels.size());
    saturated += convert(worker, sweep, frames[repeat], alignment, sketch, out);
    ++done;
  }
  if (came > 1)
    average_repeats(repeats, static_cast<int>(came), levels);
  return saturated;
}

int BScanBuilder::convert(std::size_t worker, int sweep, const hal::LineFrame& frame,
                          const SweepAlignment& alignment, DownsampledSweep* sketch,
                          std::span<std::uint8_t> levels) {
  if (comparison_)
    return comparison_->convert(worker, sweep % plan_.repeats, frame, levels);
  if (!plan_.bidirectional)
    return reconstruct_(worker, frame, levels);
  const std::span lines{buffers_[worker].lines};
  const int saturated = reconstruct_(worker, frame, lines);
  if (sketch != nullptr)
    sketch->draw(sweep, lines);
  alignment.apply(lines, plan_.runs_backwards(sweep), levels);
  return saturated;
}

} // namespace octascope::pipeline
