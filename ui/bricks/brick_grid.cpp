#include "ui/bricks/brick_grid.h"

#include <algorithm>
#include <cstddef>

#include "pipeline/threads/cpu_clones.h"
#include "ui/transfer/flow_look.h"

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

// Those of one row of bricks along the slow axis.
void BrickGrid::merge_b_scans(const pipeline::Occupancy& occupancy, int row) {
  const std::size_t slab = counts_.per_b_scan();
  const std::size_t at = slab * static_cast<std::size_t>(row);
  std::fill_n(highest_.data() + at, slab, std::uint8_t{0});
  std::fill_n(lowest_.data() + at, slab, std::uint8_t{255});
  // Cell i lies between B-scans i−1 and i.
  const int first = std::max((row << pipeline::brick_b_shift) - 1, 0);
  const int last =
      std::min(((row + 1) << pipeline::brick_b_shift) - 1, occupancy.geometry().b_scans - 1);
  for (int b = first; b <= last; ++b) {
    raise(highest_.data() + at, occupancy.highest(b).data(), slab);
    lower(lowest_.data() + at, occupancy.lowest(b).data(), slab);
  }
}

// `is_occupied` is asked for each brick once its highest and lowest are there, and may change them.
template <class Occupied>
void BrickGrid::update_rows(const pipeline::Occupancy& occupancy, WorkTeam* team,
                            std::span<const std::uint8_t> stale, Occupied is_occupied) {
  resize(occupancy.bricks());
  const std::size_t slab = counts_.per_b_scan();
  run_pieces(team, static_cast<std::uint32_t>(counts_.b), [&](std::uint32_t row) {
    if (!stale.empty() && stale[row] == 0)
      return;
    merge_b_scans(occupancy, static_cast<int>(row));
    for (std::size_t i = row * slab; i < (row + 1) * slab; ++i)
      occupied_[i] = is_occupied(i) ? 1 : 0;
  });
  const auto occupied = std::ranges::count(occupied_, std::uint8_t{1});
  occupied_share_ = static_cast<double>(occupied) / static_cast<double>(occupied_.size());
}

void BrickGrid::update(const pipeline::Occupancy& occupancy, const VisibleLevels& levels,
                       Visibility visibility, WorkTeam* team, std::span<const std::uint8_t> stale,
                       const BrickGrid* also) {
  update_rows(occupancy, team, stale, [&](std::size_t i) {
    if (visibility == Visibility::everything) {
      highest_[i] = 255;
      return true;
    }
    const int lowest = visibility == Visibility::range ? lowest_[i] : 0;
    return !levels.empty(lowest, highest_[i]) || (also != nullptr && also->occupied_[i] != 0);
  });
}

void BrickGrid::update_flow(const pipeline::Occupancy& flow, bool all, WorkTeam* team,
                            std::span<const std::uint8_t> stale) {
  update_rows(flow, team, stale, [&](std::size_t i) {
    if (all)
      highest_[i] = 255;
    return highest_[i] >= first_seen_flow;
  });
}

} // namespace octascope::ui
