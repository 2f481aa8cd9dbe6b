// Where a volume has tissue, from the highest levels of its bricks (pipeline/volume/occupancy.h).
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "pipeline/volume/volume.h"
#include "ui/layout/crop.h"

namespace octascope::ui {

// A brick has tissue if its highest level is clearly above what is usual in bricks of noise: the
// lowest high peak among the highest levels of all bricks.
//
// Threads: one at a time. Allocates only when the geometry changes.
class TissueMap {
public:
  // `states` tell which B-scans were received.
  void update(const pipeline::Occupancy& occupancy, std::span<const pipeline::BScanState> states);

  // Where the en-face picture of an A-scan begins: at the surface; or, where a front layer such as
  // the cornea has an empty gap behind it, at the end of that gap. Smoothed over neighbouring
  // bricks, and interpolated along slopes. Where there is no tissue, the number of depths.
  struct Begin {
    int depth = 0;
    bool behind_gap = false;
  };
  Begin begin_of(int b, int a) const {
    static_assert(brick_b_scans == 2, "a quarter of the way to the next row");
    const Brick& here = brick_of(b, a);
    const auto within = static_cast<std::size_t>(a & (brick_a_scans - 1));
    if (!here.even)
      return {here.depths[within], here.behind_gap};
    const Brick& next = brick_of(std::clamp(b % 2 == 0 ? b - 1 : b + 1, 0, 2 * rows_ - 1), a);
    return {(3 * here.depths[within] + next.depths[within] + 2) / 4, here.behind_gap};
  }

  // Whether that is one surface all around: else it jumps from brick to brick.
  bool even_at(int b, int a) const { return brick_of(b, a).even; }

  // The same of the columns of bricks whose middles lie around an A-scan, and how much each counts
  // there: bilinear.
  struct Around {
    std::array<Begin, 4> begins;
    std::array<float, 4> shares;
  };
  Around around(int b, int a) const;

  // Whether the last update() changed anything of that above for the B-scan.
  bool changed_at(int b) const {
    const int row = b >> pipeline::brick_b_shift;
    return std::any_of(changed_.begin() + std::max(row - 1, 0),
                       changed_.begin() + std::min(row + 2, rows_),
                       [](std::uint8_t changed) { return changed != 0; });
  }

  // The lowest of what is tissue.
  std::uint8_t level() const { return level_; }

  // What holds the tissue, with a little room around it, in sixteenths of each extent. Everything
  // if there is hardly any tissue.
  const Crop& extents() const { return extents_; }

private:
  static constexpr int brick_a_scans = 1 << pipeline::brick_a_shift;
  static constexpr int brick_b_scans = 1 << pipeline::brick_b_shift;
  // A column of bricks, of the first of the B-scans that share it.
  struct Found {
    std::uint16_t brick = 0;
    bool behind_gap = false;
  };
  struct Brick {
    std::array<std::uint16_t, brick_a_scans> depths{};
    bool behind_gap = false;
    bool even = false;
    bool operator==(const Brick&) const = default;
  };

  const Brick& brick_of(int b, int a) const {
    return smoothed_[static_cast<std::size_t>((b >> pipeline::brick_b_shift) * bricks_.a +
                                              (a >> pipeline::brick_a_shift))];
  }

  void find_begins(const pipeline::Occupancy& occupancy, int row);
  void smooth();
  Brick interpolated(int row, int a) const;
  bool is_even(int row, int a) const;
  void find_extents(std::span<const pipeline::BScanState> states);

  pipeline::VolumeGeometry geometry_;
  pipeline::BrickCounts bricks_;
  std::uint8_t level_ = 255;
  int rows_ = 0;                                      // of bricks along the slow axis
  std::vector<Found> found_;                          // [row][a brick]
  std::vector<Found> along_;                          // likewise, medians along the fast axis
  std::vector<Found> median_;                         // likewise
  std::vector<Brick> smoothed_;                       // likewise
  std::vector<std::uint8_t> changed_;                 // by row, by the last update()
  std::vector<std::uint32_t> at_depth_, at_a_, at_b_; // how many bricks with tissue
  std::vector<std::uint8_t> is_tissue_;               // of one column
  Crop extents_;
};

// Follows the extents without a jump from volume to volume: grows at once, shrinks only after
// twenty volumes that all need less, and then by two sixteenths or more. Begins with the first.
class SteadyCrop {
public:
  void follow(const Crop& needed);
  Crop current() const { return current_.value_or(Crop{}); }

private:
  std::optional<Crop> current_;
  Crop widest_; // needed since it last changed
  int volumes_ = 0;
};

} // namespace octascope::ui
