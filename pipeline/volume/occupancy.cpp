#include "pipeline/volume/occupancy.h"

#include <algorithm>
#include <array>

#include "pipeline/threads/cpu_clones.h"
#include "pipeline/volume/volume.h"

namespace octascope::pipeline {

namespace {

constexpr int brick_depths = 1 << brick_depth_shift;
constexpr int brick_a_scans = 1 << brick_a_shift;
constexpr int longest_strip = 2048; // depth bins at a time: two strips stay on the stack

using Strip = std::array<std::uint8_t, longest_strip + brick_depths>; // with room behind the last

// The extremes of some A-scans, depth bin by depth bin.
OCTASCOPE_CPU_CLONES
void extremes_of_a_scans(const std::uint8_t* levels, std::size_t pitch, int a_scans, int depths,
                         std::uint8_t* __restrict highest, std::uint8_t* __restrict lowest) {
  std::copy_n(levels, depths, highest);
  std::copy_n(levels, depths, lowest);
  for (int a = 1; a < a_scans; ++a) {
    levels += pitch;
    for (int z = 0; z < depths; ++z) {
      highest[z] = std::max(highest[z], levels[z]);
      lowest[z] = std::min(lowest[z], levels[z]);
    }
  }
}

// Bricks share their border's bin. The strips are used up: each step doubles how many bins one
// stands for. A brick of nothing, whose highest is 0 and lowest 255, gets 0 twice: as empty as can
// be, under any transfer function.
OCTASCOPE_CPU_CLONES
void extremes_of_bricks(std::uint8_t* high, std::uint8_t* low, int bricks,
                        std::uint8_t* __restrict highest, std::uint8_t* __restrict lowest) {
  const int bins = bricks * brick_depths;
  for (int reach = 1; reach < brick_depths; reach *= 2)
    for (int z = 0; z < bins; ++z) {
      high[z] = std::max(high[z], high[z + reach]);
      low[z] = std::min(low[z], low[z + reach]);
    }
  for (int brick = 0; brick < bricks; ++brick) {
    const int z = brick * brick_depths;
    highest[brick] = std::max(high[z], high[z + 1]);
    lowest[brick] = std::min({low[z], low[z + 1], highest[brick]});
  }
}

void forget(Strip& high, Strip& low, int first, int end) {
  std::fill(high.begin() + first, high.begin() + end, std::uint8_t{0});
  std::fill(low.begin() + first, low.begin() + end, std::uint8_t{255});
}

int bricks_of(int cells, int shift) {
  return (cells + (1 << shift) - 1) >> shift;
}

} // namespace

BrickCounts count_bricks(const VolumeGeometry& geometry) {
  return {bricks_of(geometry.depths, brick_depth_shift),
          bricks_of(geometry.a_scans + 1, brick_a_shift),
          bricks_of(geometry.b_scans + 1, brick_b_shift)};
}

Occupancy::Occupancy(const VolumeGeometry& geometry, int first_depth)
    : geometry_{geometry}, bricks_{count_bricks(geometry)}, first_depth_{first_depth} {
  const std::size_t size = bricks_.per_b_scan() * static_cast<std::size_t>(geometry.b_scans);
  highest_.resize(size);
  lowest_.resize(size);
}

void Occupancy::update(int b, std::span<const std::uint8_t> levels) noexcept {
  const auto pitch = static_cast<std::size_t>(geometry_.depths);
  const std::size_t row = bricks_.per_b_scan() * static_cast<std::size_t>(b);
  Strip high{};
  Strip low{};
  for (int brick_a = 0; brick_a < bricks_.a; ++brick_a) {
    const int first_a = std::max(brick_a * brick_a_scans - 1, 0);
    const int last_a = std::min((brick_a + 1) * brick_a_scans - 1, geometry_.a_scans - 1);
    for (int strip = 0; strip < geometry_.depths; strip += longest_strip) {
      const int depths = std::min(longest_strip + 1, geometry_.depths - strip);
      extremes_of_a_scans(levels.data() + static_cast<std::size_t>(first_a) * pitch +
                              static_cast<std::size_t>(strip),
                          pitch, last_a - first_a + 1, depths, high.data(), low.data());
      const int bricks =
          bricks_of(std::min(longest_strip, geometry_.depths - strip), brick_depth_shift);
      forget(high, low, 0, std::clamp(first_depth_ - strip, 0, depths));
      forget(high, low, depths, (bricks + 1) * brick_depths);
      const std::size_t at =
          row + static_cast<std::size_t>(brick_a) * static_cast<std::size_t>(bricks_.depth) +
          static_cast<std::size_t>(strip >> brick_depth_shift);
      extremes_of_bricks(high.data(), low.data(), bricks, highest_.data() + at,
                         lowest_.data() + at);
    }
  }
}

void Occupancy::update(const Volume& volume) noexcept {
  for (int b = 0; b < geometry_.b_scans; ++b)
    update(b, volume.b_scan(b));
}

void Occupancy::copy(int b, const Occupancy& from) noexcept {
  std::ranges::copy(from.highest(b), row(highest_, b).begin());
  std::ranges::copy(from.lowest(b), row(lowest_, b).begin());
}

void Occupancy::widen_below(int counts) noexcept {
  for (int b = 0; b < geometry_.b_scans; ++b)
    widen_below(b, counts);
}

void Occupancy::widen_below(int b, int counts) noexcept {
  for (std::uint8_t& lowest : row(lowest_, b))
    lowest = static_cast<std::uint8_t>(std::max(lowest - counts, 0));
}

} // namespace octascope::pipeline
