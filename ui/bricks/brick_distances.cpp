#include "ui/bricks/brick_distances.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <utility>

#include "pipeline/threads/cpu_clones.h"

namespace octascope::ui {

namespace {

// What lies `step` strides before and after counts, if that is more than its own.
OCTASCOPE_CPU_CLONES
void take_nearer(const std::uint8_t* from, std::uint8_t* __restrict to, std::size_t length,
                 std::size_t stride, std::uint8_t step) {
  if (length <= stride)
    return;
  for (std::size_t i = 0; i < length - stride; ++i)
    to[i] = std::min(to[i], std::max(from[i + stride], step));
  for (std::size_t i = stride; i < length; ++i)
    to[i] = std::min(to[i], std::max(from[i - stride], step));
}

OCTASCOPE_CPU_CLONES
void take_nearer_slab(const std::uint8_t* from, std::uint8_t* __restrict to, std::size_t length,
                      std::uint8_t step) {
  for (std::size_t i = 0; i < length; ++i)
    to[i] = std::min(to[i], std::max(from[i], step));
}

// The least, along one axis, of the greater of how far a brick lies and its own distance.
void spread(const std::uint8_t* from, std::uint8_t* to, std::size_t length, std::size_t stride) {
  std::copy_n(from, length, to);
  for (std::size_t step = 1; step < DistancesAround::most; ++step)
    take_nearer(from, to, length, step * stride, static_cast<std::uint8_t>(step));
}

OCTASCOPE_CPU_CLONES
void combine(const std::uint8_t* highest, const std::uint8_t* distance,
             std::uint16_t* __restrict to, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i)
    to[i] = static_cast<std::uint16_t>((highest[i] << 8U) | distance[i]);
}

OCTASCOPE_CPU_CLONES
void take_least(std::uint8_t* __restrict to, const std::uint8_t* from, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i)
    to[i] = std::min(to[i], from[i]);
}

// Distances along a line of bricks, from those of the lines beside it: `beside` is the least of
// them at the same depth. Rays go towards the line's end.
void measure_line_up(const std::uint8_t* occupied, const std::uint8_t* beside, std::size_t length,
                     std::uint8_t* distance) {
  std::uint8_t behind = DistancesAhead::most; // the least at the depth behind, on all four lines
  for (std::size_t z = length; z-- > 0;) {
    const std::uint8_t least = std::min(beside[z], behind);
    const auto one_more = static_cast<std::uint8_t>(least + (least < DistancesAhead::most ? 1 : 0));
    distance[z] = occupied[z] != 0 ? std::uint8_t{0} : one_more;
    behind = std::min(beside[z], distance[z]);
  }
}

// … towards its beginning.
void measure_line_down(const std::uint8_t* occupied, const std::uint8_t* beside, std::size_t length,
                       std::uint8_t* distance) {
  std::uint8_t behind = DistancesAhead::most;
  for (std::size_t z = 0; z < length; ++z) {
    const std::uint8_t least = std::min(beside[z], behind);
    const auto one_more = static_cast<std::uint8_t>(least + (least < DistancesAhead::most ? 1 : 0));
    distance[z] = occupied[z] != 0 ? std::uint8_t{0} : one_more;
    behind = std::min(beside[z], distance[z]);
  }
}

} // namespace

// A Chebyshev distance is the greatest of those along the axes: one axis after the other.
void DistancesAround::measure(const BrickGrid& grid, WorkTeam* team) {
  const pipeline::BrickCounts& counts = grid.counts();
  const auto line = static_cast<std::size_t>(counts.depth);
  const std::size_t slab = counts.per_b_scan();
  const std::size_t all = counts.all();
  within_.resize(all);
  distance_.resize(all);
  numbers_.resize(all);
  run_pieces(team, static_cast<std::uint32_t>(counts.b), [&](std::uint32_t b) {
    std::uint8_t* const distance = distance_.data() + b * slab;
    std::uint8_t* const within = within_.data() + b * slab;
    std::ranges::transform(
        grid.occupied().subspan(b * slab, slab), distance,
        [](std::uint8_t occupied) { return occupied != 0 ? std::uint8_t{0} : std::uint8_t{most}; });
    for (std::size_t at = 0; at < slab; at += line)
      spread(distance + at, within + at, line, 1);
    spread(within, distance, slab, line);
  });
  run_pieces(team, static_cast<std::uint32_t>(counts.b), [&](std::uint32_t b) {
    spread_slabs(b, slab, static_cast<std::size_t>(counts.b));
    combine(grid.highest().data() + b * slab, within_.data() + b * slab, numbers_.data() + b * slab,
            slab);
  });
}

// Into `within_`, of one slab, from those before and after it.
void DistancesAround::spread_slabs(std::size_t b, std::size_t slab, std::size_t slabs) {
  std::uint8_t* const to = within_.data() + b * slab;
  std::copy_n(distance_.data() + b * slab, slab, to);
  for (std::size_t step = 1; step < most; ++step) {
    if (b >= step)
      take_nearer_slab(distance_.data() + (b - step) * slab, to, slab,
                       static_cast<std::uint8_t>(step));
    if (b + step < slabs)
      take_nearer_slab(distance_.data() + (b + step) * slab, to, slab,
                       static_cast<std::uint8_t>(step));
  }
}

void DistancesAhead::measure(const BrickGrid& grid, unsigned wanted, WorkTeam* team) {
  const std::size_t all = grid.counts().all();
  distance_.resize(octants * all);
  line_.resize(octants * static_cast<std::size_t>(grid.counts().depth));
  numbers_.resize(octants * all + 1);
  std::array<unsigned, octants> missing{};
  std::uint32_t count = 0;
  for (unsigned octant = 0; octant < octants; ++octant)
    if ((wanted & ~measured_ & (1U << octant)) != 0)
      missing[count++] = octant;
  run_pieces(team, count, [&](std::uint32_t i) { measure_octant(grid, missing[i]); });
  measured_ |= wanted;
}

// A cube of edge e + 1 is empty where this brick is and the cubes of edge e of its seven neighbours
// ahead are: from the far corner backwards, each brick once.
void DistancesAhead::measure_octant(const BrickGrid& grid, unsigned octant) {
  const pipeline::BrickCounts& n = grid.counts();
  const auto length = static_cast<std::size_t>(n.depth);
  std::uint8_t* const distance = distance_.data() + octant * n.all();
  const std::span line{line_.data() + octant * length, length};
  const bool up_z = (octant & 1U) != 0;
  const int ahead_a = (octant & 2U) != 0 ? 1 : -1;
  const int ahead_b = (octant & 4U) != 0 ? 1 : -1;
  const auto inside = [](int i, int count) { return i >= 0 && i < count; };
  const auto line_at = [&](int a, int b) {
    return (static_cast<std::size_t>(b) * static_cast<std::size_t>(n.a) +
            static_cast<std::size_t>(a)) *
           length;
  };
  for (int i = n.b; i-- > 0;) {
    const int b = ahead_b > 0 ? i : n.b - 1 - i;
    for (int j = n.a; j-- > 0;) {
      const int a = ahead_a > 0 ? j : n.a - 1 - j;
      std::ranges::fill(line, std::uint8_t{most});
      for (const auto& [next_a, next_b] :
           {std::pair{a + ahead_a, b}, {a, b + ahead_b}, {a + ahead_a, b + ahead_b}})
        if (inside(next_a, n.a) && inside(next_b, n.b))
          take_least(line.data(), distance + line_at(next_a, next_b), length);
      const std::size_t at = line_at(a, b);
      (up_z ? measure_line_up : measure_line_down)(grid.occupied().data() + at, line.data(), length,
                                                   distance + at);
    }
  }
  combine(grid.highest().data(), distance, numbers_.data() + octant * n.all(), n.all());
}

} // namespace octascope::ui
