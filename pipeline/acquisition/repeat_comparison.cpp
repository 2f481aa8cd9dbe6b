#include "pipeline/acquisition/repeat_comparison.h"

#include <algorithm>
#include <utility>

#include "pipeline/threads/cpu_clones.h"
#include "pipeline/volume/flow_scale.h"

namespace octascope::pipeline {

namespace {

OCTASCOPE_CPU_CLONES
void quantise(const float* __restrict flow, std::size_t count, std::uint8_t* __restrict counts) {
  for (std::size_t i = 0; i < count; ++i)
    counts[i] = quantise_flow(flow[i]);
}

} // namespace

hal::Result<> RepeatComparison::check(const ScanPlan& plan) {
  if (plan.repeats < BScanFlow::fewest_repeats)
    return hal::fail(hal::ErrorCode::invalid_argument,
                     "flow is told from repeated sweeps: repeats is {}, expected {} to {}; "
                     "--repeats 2, or repeats = 2 in [scan]",
                     plan.repeats, BScanFlow::fewest_repeats, BScanFlow::most_repeats);
  if (plan.bidirectional)
    return hal::fail(
        hal::ErrorCode::invalid_argument,
        "flow is told from repeats in one direction, and those of a bidirectional scan "
        "run there and back by turns; leave out --bidirectional and bidirectional in "
        "[scan], or flow");
  return {};
}

hal::Result<RepeatComparison> RepeatComparison::create(const ScanPlan& plan, std::size_t workers,
                                                       ReconstructBins reconstruct) {
  HAL_CHECK(check(plan));
  RepeatComparison comparison{plan, std::move(reconstruct)};
  const VolumeGeometry geometry = plan.geometry();
  const std::size_t voxels = geometry.b_scan_voxels();
  for (std::size_t worker = 0; worker < workers; ++worker) {
    HAL_TRY(auto flow,
            BScanFlow::create(
                {.repeats = plan.repeats, .a_scans = geometry.a_scans, .depths = geometry.depths}));
    comparison.buffers_.push_back(
        {.flow = std::move(flow),
         .bins = std::vector<PackedBin>(voxels * static_cast<std::size_t>(plan.repeats)),
         .told = std::vector<float>(voxels),
         .decorrelation = std::vector<float>(voxels),
         .saturated = std::vector<std::uint8_t>(static_cast<std::size_t>(geometry.a_scans))});
  }
  return comparison;
}

void RepeatComparison::begin(std::size_t worker) noexcept {
  buffers_[worker].came = 0;
  std::ranges::fill(buffers_[worker].saturated, std::uint8_t{0});
}

int RepeatComparison::convert(std::size_t worker, int repeat, const hal::LineFrame& frame,
                              std::span<std::uint8_t> levels) {
  Buffers& buffers = buffers_[worker];
  ++buffers.came;
  const std::span bins{buffers.bins};
  return reconstruct_(
      worker, frame,
      {bins.subspan(static_cast<std::size_t>(repeat) * levels.size(), levels.size()), levels,
       buffers.saturated});
}

FlowState RepeatComparison::tell(std::size_t worker, std::span<std::uint8_t> flow) noexcept {
  Buffers& buffers = buffers_[worker];
  if (!is_whole(worker)) {
    std::ranges::fill(flow, flow_untold);
    return FlowState::none;
  }
  darken_saturated(buffers);
  const FlowOutcome outcome =
      buffers.flow.compute(buffers.bins, buffers.told, buffers.decorrelation);
  quantise(buffers.told.data(), flow.size(), flow.data());
  leave_saturated_untold(buffers, flow);
  return outcome.left_out ? FlowState::left_out : FlowState::told;
}

// Without power in any repeat such an A-scan says nothing, to its neighbours' kernels and of motion.
void RepeatComparison::darken_saturated(Buffers& buffers) const noexcept {
  const std::size_t depths = buffers.told.size() / buffers.saturated.size();
  for (std::size_t a = 0; a < buffers.saturated.size(); ++a)
    for (int repeat = 0; buffers.saturated[a] != 0 && repeat < plan_.repeats; ++repeat)
      std::fill_n(buffers.bins.begin() +
                      static_cast<std::ptrdiff_t>(
                          static_cast<std::size_t>(repeat) * buffers.told.size() + a * depths),
                  depths, PackedBin{});
}

// With lateral motion the dark A-scans of two repeats lie beside each other, within the limits of
// what is corrected.
void RepeatComparison::leave_saturated_untold(const Buffers& buffers,
                                              std::span<std::uint8_t> flow) const noexcept {
  constexpr int reach = kernel_a_scans / 2 + BulkMotionEstimator::most_lateral_a_scans;
  const auto a_scans = static_cast<int>(buffers.saturated.size());
  const std::size_t depths = flow.size() / buffers.saturated.size();
  for (int a = 0; a < a_scans; ++a) {
    if (buffers.saturated[static_cast<std::size_t>(a)] == 0)
      continue;
    const auto first = static_cast<std::size_t>(std::max(a - reach, 0));
    const auto last = static_cast<std::size_t>(std::min(a + reach, a_scans - 1));
    std::ranges::fill(flow.subspan(first * depths, (last - first + 1) * depths), flow_untold);
  }
}

} // namespace octascope::pipeline
