#include "ui/ray_caster/brick_grid.h"

#include <algorithm>
#include <cstddef>

#include "pipeline/cpu_clones.h"

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

// 1 where a neighbour `stride` before or after is 1, within one line or slab of `length`.
OCTASCOPE_CPU_CLONES
void spread(const std::uint8_t* from, std::uint8_t* __restrict to, std::size_t length,
            std::size_t stride) {
  std::copy_n(from, length, to);
  if (length <= stride)
    return;
  for (std::size_t i = 0; i < length - stride; ++i)
    to[i] = to[i] | from[i + stride];
  for (std::size_t i = stride; i < length; ++i)
    to[i] = to[i] | from[i - stride];
}

// Counts one brick more for all that are still out of reach; how many these are.
OCTASCOPE_CPU_CLONES
std::size_t count_unreached(const std::uint8_t* reach, std::uint8_t* __restrict distance,
                            std::size_t count) {
  std::size_t unreached = 0;
  for (std::size_t i = 0; i < count; ++i) {
    distance[i] = static_cast<std::uint8_t>(distance[i] + (1 - reach[i]));
    unreached += 1U - reach[i];
  }
  return unreached;
}

} // namespace

void BrickGrid::resize(const pipeline::BrickCounts& counts) {
  if (counts == counts_)
    return;
  counts_ = counts;
  bricks_.assign(counts.all() + 1, 0);
  for (auto* plane : {&highest_, &lowest_, &distance_, &reach_, &next_})
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

// Each round reaches one brick farther, also diagonally: one axis after the other.
bool BrickGrid::grow_reach() {
  const auto line = static_cast<std::size_t>(counts_.depth);
  const std::size_t slab = counts_.per_b_scan();
  const std::size_t all = counts_.all();
  for (std::size_t at = 0; at < all; at += line)
    spread(reach_.data() + at, next_.data() + at, line, 1);
  for (std::size_t at = 0; at < all; at += slab)
    spread(next_.data() + at, reach_.data() + at, slab, line);
  spread(reach_.data(), next_.data(), all, slab);
  std::swap(reach_, next_);
  return count_unreached(reach_.data(), distance_.data(), all) > 0;
}

void BrickGrid::measure_distances() {
  for (std::size_t i = 0; i < distance_.size(); ++i)
    distance_[i] = 1 - reach_[i];
  for (int distance = 1; distance < most_distance; ++distance)
    if (!grow_reach())
      break;
}

void BrickGrid::update(const pipeline::Occupancy& occupancy, const VisibleLevels& levels,
                       Visibility visibility) {
  resize(occupancy.bricks());
  merge_b_scans(occupancy);
  std::size_t occupied = 0;
  for (std::size_t i = 0; i < reach_.size(); ++i) {
    const int lowest = visibility == Visibility::range ? lowest_[i] : 0;
    const bool empty = visibility != Visibility::everything && levels.empty(lowest, highest_[i]);
    reach_[i] = empty ? 0 : 1;
    occupied += reach_[i];
  }
  occupied_share_ = static_cast<double>(occupied) / static_cast<double>(reach_.size());
  measure_distances();
  for (std::size_t i = 0; i < distance_.size(); ++i) {
    const unsigned highest = visibility == Visibility::everything ? 255 : highest_[i];
    bricks_[i] = static_cast<std::uint16_t>((highest << 8U) | distance_[i]);
  }
}

} // namespace octascope::ui
