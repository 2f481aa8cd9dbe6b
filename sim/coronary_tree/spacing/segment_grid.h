// Finds the segments of a tree that come near each other.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "pipeline/vessels/tree.h"
#include "sim/coronary_tree/heart/vector3.h"

namespace octascope::sim {

// Grids of cells, each level's twice as wide as those of the one below. Segments are cut into equal
// pieces, each with a ball around it and its radius. A segment's level is the lowest one whose cells
// are as wide as its balls; each ball is in the cell of its middle. Large segments look for small ones,
// since there are fewer of them.
//
// Keeps no reference to the tree; finds what was there when it was made.
class SegmentGrid {
public:
  // Segments count as so many times as thick as they are.
  SegmentGrid(const pipeline::VesselTree& tree, float thicker);

  // Finds each other segment of which a ball meets one of this one's, except those that find this one
  // themselves: of each pair one finds the other. In rising order, into `found`, whose contents are
  // replaced. Not for roots. May be called from several threads at once.
  void find_near(const pipeline::VesselTree& tree, std::uint32_t segment,
                 std::vector<std::uint32_t>& found) const;

private:
  struct Ball {
    float x = 0; // of its middle, from the origin
    float y = 0;
    float z = 0;
    float radius_mm = 0;
  };
  struct Item {
    Ball ball;
    std::uint32_t segment = 0;
  };
  struct Level {
    float cell_mm = 0;
    float per_mm = 0; // cells
    std::uint32_t size[3] = {};
    std::vector<std::uint32_t> first; // of each cell, and one more
    std::vector<Item> items;

    std::uint32_t index(float place, int axis) const { // `place` from the origin
      const float cell = place * per_mm;
      return cell <= 0 ? 0 : std::min(static_cast<std::uint32_t>(cell), size[axis] - 1);
    }
    std::size_t cell(std::uint32_t x, std::uint32_t y, std::uint32_t z) const {
      return (static_cast<std::size_t>(z) * size[1] + y) * size[0] + x;
    }
    std::size_t cell_of(const Ball& ball) const {
      return cell(index(ball.x, 0), index(ball.y, 1), index(ball.z, 2));
    }
  };
  struct Pieces {
    Ball first;
    float step_x = 0; // from one to the next
    float step_y = 0;
    float step_z = 0;
    int count = 1;

    Ball at(int i) const {
      const auto steps = static_cast<float>(i);
      return {first.x + steps * step_x, first.y + steps * step_y, first.z + steps * step_z,
              first.radius_mm};
    }
  };

  static bool meet(const Ball& a, const Ball& b) {
    const float x = a.x - b.x;
    const float y = a.y - b.y;
    const float z = a.z - b.z;
    const float reach = a.radius_mm + b.radius_mm;
    return x * x + y * y + z * z < reach * reach;
  }

  Pieces pieces_of(const pipeline::VesselTree& tree, std::uint32_t segment) const;
  std::size_t level_of(const Ball& ball) const;
  void add_levels(Vector3 extent, float widest_mm);

  static void find_meeting(const Level& level, const Ball& ball, std::vector<std::uint32_t>& found);

  float thicker_;
  float finest_mm_ = 0;
  Vector3 origin_;
  std::vector<Level> levels_;
};

} // namespace octascope::sim
