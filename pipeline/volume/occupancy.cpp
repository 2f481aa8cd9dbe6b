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

OCTASCOPE_CPU_CLONES
std::uint8_t highest_of(const std::uint8_t* levels, int count) {
  std::uint8_t highest = 0;
  for (int i = 0; i < count; ++i)
    highest = std::max(highest, levels[i]);
  return highest;
}

OCTASCOPE_CPU_CLONES
std::uint8_t lowest_of(const std::uint8_t* levels, int count) {
  std::uint8_t lowest = 255;
  for (int i = 0; i < count; ++i)
    lowest = std::min(lowest, levels[i]);
  return lowest;
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
  std::array<std::uint8_t, longest_strip + 1> high{};
  std::array<std::uint8_t, longest_strip + 1> low{};
  for (int brick_a = 0; brick_a < bricks_.a; ++brick_a) {
    const int first_a = std::max(brick_a * brick_a_scans - 1, 0);
    const int last_a = std::min((brick_a + 1) * brick_a_scans - 1, geometry_.a_scans - 1);
    for (int strip = 0; strip < geometry_.depths; strip += longest_strip) {
      const int depths = std::min(longest_strip + 1, geometry_.depths - strip);
      extremes_of_a_scans(levels.data() + static_cast<std::size_t>(first_a) * pitch +
                              static_cast<std::size_t>(strip),
                          pitch, last_a - first_a + 1, depths, high.data(), low.data());
      const int end = std::min(longest_strip, geometry_.depths - strip);
      for (int z = 0; z < end; z += brick_depths) {
        const int first = std::max(z, first_depth_ - strip);
        const int count = std::min(z + brick_depths + 1, depths) - first;
        const std::size_t at =
            row + static_cast<std::size_t>(brick_a) * static_cast<std::size_t>(bricks_.depth) +
            static_cast<std::size_t>((strip + z) >> brick_depth_shift);
        // What nothing is sampled from is as empty as can be, under any transfer function.
        highest_[at] = count > 0 ? highest_of(high.data() + first, count) : 0;
        lowest_[at] = count > 0 ? lowest_of(low.data() + first, count) : 0;
      }
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
