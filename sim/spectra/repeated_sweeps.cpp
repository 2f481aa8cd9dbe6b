#include "sim/spectra/repeated_sweeps.h"

#include <utility>

#include "sim/phantoms/flow_truth.h"

namespace octascope::sim {

std::span<const std::uint16_t> RepeatedSweeps::sweep(int number) const {
  const std::span<const std::byte> frame = loop->frame(0, number);
  return {reinterpret_cast<const std::uint16_t*>(frame.data()),
          static_cast<std::size_t>(plan().a_scans) * static_cast<std::size_t>(plan().samples)};
}

hal::Result<RepeatedSweeps> simulate_repeats(VolumeLoopConfig config) {
  if (config.plan.bidirectional)
    return hal::fail(
        hal::ErrorCode::invalid_argument,
        "repeated sweeps: the plan is bidirectional, expected sweeps of one direction");
  config.volumes = 1;
  RepeatedSweeps made;
  HAL_TRY(made.loop, VolumeLoop::make(config));
  made.flow = flow_truth(made.loop->phantom(), config.plan.geometry());
  made.tree = phantom_tree(made.loop->phantom());
  return made;
}

} // namespace octascope::sim
