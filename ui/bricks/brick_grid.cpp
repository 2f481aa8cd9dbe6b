#include "ui/bricks/brick_grid.h"

#include <algorithm>
#include <cstddef>
#include <utility>

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

OCTASCOPE_CPU_CLONES
void add_marked(const std::uint32_t* __restrict marks, std::size_t count,
                std::uint8_t* __restrict occupied) {
  for (std::size_t i = 0; i < count; ++i)
    occupied[i] = static_cast<std::uint8_t>(occupied[i] | (marks[i] != 0 ? 1 : 0));
}

// The first and the last that touch a row of bricks: cell i lies between B-scans i−1 and i.
std::pair<int, int> b_scans_of(int row, int b_scans) {
  return {std::max((row << pipeline::brick_b_shift) - 1, 0),
          std::min(((row + 1) << pipeline::brick_b_shift) - 1, b_scans - 1)};
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
  const auto [first, last] = b_scans_of(row, occupancy.geometry().b_scans);
  for (int b = first; b <= last; ++b) {
    raise(highest_.data() + at, occupancy.highest(b).data(), slab);
    lower(lowest_.data() + at, occupancy.lowest(b).data(), slab);
  }
}

void BrickGrid::merge_flow(const pipeline::FlowMarks& flow, int row) {
  const auto [first, last] = b_scans_of(row, flow.geometry().b_scans);
  const auto depth = static_cast<std::size_t>(counts_.depth);
  std::uint8_t* to = occupied_.data() + counts_.per_b_scan() * static_cast<std::size_t>(row);
  std::fill_n(to, counts_.per_b_scan(), std::uint8_t{0});
  for (int b = first; b <= last; ++b) {
    const auto marks = flow.of(b);
    for (std::size_t a = 0; a < static_cast<std::size_t>(counts_.a); ++a)
      add_marked(marks.data() + a * static_cast<std::size_t>(flow.row()), depth, to + a * depth);
  }
}

template <class Update>
void BrickGrid::update_rows(const pipeline::BrickCounts& counts, WorkTeam* team,
                            std::span<const std::uint8_t> stale, Update update) {
  resize(counts);
  run_pieces(team, static_cast<std::uint32_t>(counts_.b), [&](std::uint32_t row) {
    if (stale.empty() || stale[row] != 0)
      update(row);
  });
  const auto occupied = std::ranges::count(occupied_, std::uint8_t{1});
  occupied_share_ = static_cast<double>(occupied) / static_cast<double>(occupied_.size());
}

void BrickGrid::update(const pipeline::Occupancy& occupancy, const VisibleLevels& levels,
                       Visibility visibility, WorkTeam* team, std::span<const std::uint8_t> stale,
                       const BrickGrid* also) {
  const auto is_occupied = [&](std::size_t i) {
    if (visibility == Visibility::everything) {
      highest_[i] = 255;
      return true;
    }
    const int lowest = visibility == Visibility::range ? lowest_[i] : 0;
    return !levels.empty(lowest, highest_[i]) || (also != nullptr && also->occupied_[i] != 0);
  };
  update_rows(occupancy.bricks(), team, stale, [&](std::size_t row) {
    merge_b_scans(occupancy, static_cast<int>(row));
    for (std::size_t i = row * counts_.per_b_scan(); i < (row + 1) * counts_.per_b_scan(); ++i)
      occupied_[i] = is_occupied(i) ? 1 : 0;
  });
}

void BrickGrid::update_flow(const pipeline::FlowMarks& flow, bool all, WorkTeam* team,
                            std::span<const std::uint8_t> stale) {
  update_rows(count_bricks(flow.geometry()), team, stale, [&](std::size_t row) {
    const std::size_t slab = counts_.per_b_scan();
    std::uint8_t* const occupied = occupied_.data() + row * slab;
    if (all)
      std::fill_n(occupied, slab, std::uint8_t{1});
    else
      merge_flow(flow, static_cast<int>(row));
    std::transform(occupied, occupied + slab, highest_.data() + row * slab,
                   [](std::uint8_t is) { return static_cast<std::uint8_t>(is * 255); });
  });
}

} // namespace octascope::ui
