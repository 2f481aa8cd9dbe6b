// Which bricks of a volume a picture can leap over, and how far.
#pragma once

#include <cstdint>
#include <vector>

#include "pipeline/occupancy.h"
#include "ui/transfer/visible_levels.h"

namespace octascope::ui {

// What the picture shows, as far as emptiness is concerned.
enum class Visibility : std::uint8_t {
  range,     // a brick is empty where none of the levels in it can be seen
  maximum,   // … where no level up to its highest can be seen: for the maximum along a ray
  everything // no brick is empty
};

// One number a brick, in the order [b][a][depth]: its highest level in the upper 8 bits, below it
// the distance to the nearest brick that is not empty, in bricks along the axis where it is
// farthest (Chebyshev), at most most_distance; 0 for those that are not.
//
// Allocates when the number of bricks changes.
class BrickGrid {
public:
  static constexpr int most_distance = 10;

  void update(const pipeline::Occupancy& occupancy, const VisibleLevels& levels,
              Visibility visibility);

  const std::uint16_t* data() const { return bricks_.data(); }
  const pipeline::BrickCounts& counts() const { return counts_; }
  double occupied_share() const { return occupied_share_; }

private:
  void resize(const pipeline::BrickCounts& counts);
  void merge_b_scans(const pipeline::Occupancy& occupancy);
  void measure_distances();
  bool grow_reach();

  pipeline::BrickCounts counts_;
  std::vector<std::uint16_t> bricks_; // one more than there are: kernels load two at a time
  std::vector<std::uint8_t> highest_;
  std::vector<std::uint8_t> lowest_;
  std::vector<std::uint8_t> distance_;
  std::vector<std::uint8_t> reach_; // 1 within the distance reached so far
  std::vector<std::uint8_t> next_;
  double occupied_share_ = 0;
};

} // namespace octascope::ui
