// A connected group of segments, and the box around them.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "pipeline/vessels/clusters.h"

namespace octascope::pipeline {

struct TreeBox {
  std::array<float, 3> lower{std::numeric_limits<float>::max(), std::numeric_limits<float>::max(),
                             std::numeric_limits<float>::max()};
  std::array<float, 3> upper{std::numeric_limits<float>::lowest(),
                             std::numeric_limits<float>::lowest(),
                             std::numeric_limits<float>::lowest()};

  void include(const std::array<float, 3>& point) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      lower[axis] = std::min(lower[axis], point[axis]);
      upper[axis] = std::max(upper[axis], point[axis]);
    }
  }
  void include(const TreeBox& other) {
    include(other.lower);
    include(other.upper);
  }
  float longest_side() const {
    return std::max({upper[0] - lower[0], upper[1] - lower[1], upper[2] - lower[2], 0.0F});
  }
  std::array<float, 3> middle() const {
    return {lower[0] + (upper[0] - lower[0]) / 2, lower[1] + (upper[1] - lower[1]) / 2,
            lower[2] + (upper[2] - lower[2]) / 2};
  }
};

// Nearby places have nearby codes: the bits of the three axes interleaved (Morton 1966).
inline std::uint64_t morton_code(const TreeBox& within, const std::array<float, 3>& place) {
  constexpr std::uint32_t most = (1U << 16) - 1;
  std::uint64_t code = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const float side = within.upper[axis] - within.lower[axis];
    const float share = side > 0 ? (place[axis] - within.lower[axis]) / side : 0;
    std::uint64_t bits = std::min(
        static_cast<std::uint32_t>(std::max(share, 0.0F) * static_cast<float>(most)), most);
    bits = (bits | bits << 16) & 0x0000FF0000FFULL;
    bits = (bits | bits << 8) & 0x00F00F00F00FULL;
    bits = (bits | bits << 4) & 0x0C30C30C30C3ULL;
    bits = (bits | bits << 2) & 0x249249249249ULL;
    code |= bits << axis;
  }
  return code;
}

struct TreePiece {
  TreeBox box; // of both ends of every segment
  float thinnest_mm = std::numeric_limits<float>::max();
  float shortest_mm = std::numeric_limits<float>::max();
  std::uint32_t segments = 0;
  std::uint32_t parent = no_parent; // the node it is attached to
  std::uint32_t kind = 0;           // pieces of unequal kinds do not share a cluster

  void join(const TreePiece& other) {
    box.include(other.box);
    thinnest_mm = std::min(thinnest_mm, other.thinnest_mm);
    shortest_mm = std::min(shortest_mm, other.shortest_mm);
    segments += other.segments;
  }

  // Whether the steps of such a box are small enough: errors up to a tenth of the thinnest vessel's
  // radius, or small beside the shortest segment, are invisible.
  bool fine_enough() const {
    // √3 / 2 steps are the most that rounding does; references for directions may lengthen a side
    // by a half.
    constexpr float sides_of_radius = 0.1F * vessel_place_steps / (0.87F * 1.5F);
    constexpr float sides_of_length = 256;
    constexpr float thinner_is_none_mm = 1e-3F;
    return segments <= 1 ||
           box.longest_side() <=
               std::max(sides_of_radius * std::max(thinnest_mm, thinner_is_none_mm),
                        sides_of_length * shortest_mm);
  }
};

} // namespace octascope::pipeline
