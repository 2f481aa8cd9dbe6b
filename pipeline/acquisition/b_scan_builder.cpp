#include "pipeline/acquisition/b_scan_builder.h"

#include <algorithm>

#include "pipeline/threads/cpu_clones.h"

namespace octascope::pipeline {

namespace {

constexpr std::uint32_t one = 65536;

OCTASCOPE_CPU_CLONES
void average(const std::uint8_t* repeats, std::size_t size, std::size_t count,
             std::uint8_t* __restrict result) {
  // Multiplying by 1/count in 16-bit fixed point, rounded up, divides sums of so few bytes exactly.
  const auto weight = static_cast<std::uint32_t>((one + count - 1) / count);
  const auto half = static_cast<std::uint32_t>(count / 2);
  for (std::size_t i = 0; i < size; ++i) {
    std::uint32_t sum = half;
    for (std::size_t repeat = 0; repeat < count; ++repeat)
      sum += repeats[repeat * size + i];
    result[i] = static_cast<std::uint8_t>(sum * weight >> 16U);
  }
}

} // namespace

void average_repeats(std::span<const std::uint8_t> repeats, int count,
                     std::span<std::uint8_t> result) {
  if (count == 1)
    std::copy_n(repeats.begin(), result.size(), result.begin());
  else
    average(repeats.data(), result.size(), static_cast<std::size_t>(count), result.data());
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
