#include "ui/bricks/brick_grid.h"

#include <algorithm>
#include <cstddef>

#include "pipeline/threads/cpu_clones.h"

namespace octascope::ui {

namespace {

OCTASCOPE_CPU_CLONES
void raise(std::uint8_t* __restrict to, const std::uint8_t* from, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i)
    to[i] = std::max(to[i], from[i]);
}

OCTASCOPE_CPU_CLONES
void lower(std::uint8_t* __restrict to, const std::uint8_t* from, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i)
    to[i] = std::min(to[i], from[i]);
}

} // namespace

void BrickGrid::resize(const pipeline::BrickCounts& counts) {
  if (counts == counts_)
    return;
  counts_ = counts;
  for (auto* plane : {&highest_, &lowest_, &occupied_})
    plane->assign(counts.all(), 0);
}

void BrickGrid::merge_b_scans(const pipeline::Occupancy& occupancy) {
  const std::size_t slab = counts_.per_b_scan();
  std::ranges::fill(highest_, std::uint8_t{0});
  std::ranges::fill(lowest_, std::uint8_t{255});
  for (int brick = 0; brick < counts_.b; ++brick) {
    const std::size_t at = slab * static_cast<std::size_t>(brick);
    // Cell i lies between B-scans i−1 and i.
    const int first = std::max((brick << pipeline::brick_b_shift) - 1, 0);
    const int last =
        std::min(((brick + 1) << pipeline::brick_b_shift) - 1, occupancy.geometry().b_scans - 1);
    for (int b = first; b <= last; ++b) {
      raise(highest_.data() + at, occupancy.highest(b).data(), slab);
      lower(lowest_.data() + at, occupancy.lowest(b).data(), slab);
    }
  }
}

void BrickGrid::update(const pipeline::Occupancy& occupancy, const VisibleLevels& levels,
                       Visibility visibility) {
  resize(occupancy.bricks());
  merge_b_scans(occupancy);
  if (visibility == Visibility::everything)
    std::ranges::fill(highest_, std::uint8_t{255});
  std::size_t occupied = 0;
  for (std::size_t i = 0; i < occupied_.size(); ++i) {
    const int lowest = visibility == Visibility::range ? lowest_[i] : 0;
    const bool empty = visibility != Visibility::everything && levels.empty(lowest, highest_[i]);
    occupied_[i] = empty ? 0 : 1;
    occupied += occupied_[i];
  }
  occupied_share_ = static_cast<double>(occupied) / static_cast<double>(occupied_.size());
}

} // namespace octascope::ui
