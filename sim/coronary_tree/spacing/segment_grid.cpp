#include "sim/coronary_tree/spacing/segment_grid.h"

#include "sim/coronary_tree/spacing/segments.h"

namespace octascope::sim {
namespace {

// The edge of cells of which there are four for each node.
float finest_cell_mm(Vector3 extent, std::size_t nodes) {
  constexpr double least_mm = 0.05;
  const double volume = std::max(extent.x, 1.0) * std::max(extent.y, 1.0) * std::max(extent.z, 1.0);
  double cell = least_mm;
  while (cell * cell * cell * 4 * static_cast<double>(nodes) < volume)
    cell *= 1.25;
  return static_cast<float>(cell);
}

} // namespace

SegmentGrid::Pieces SegmentGrid::pieces_of(const pipeline::VesselTree& tree,
                                           std::uint32_t segment) const {
  constexpr float rounding_mm = 2e-4F;
  const Line line = segment_line(tree, segment);
  const Vector3 along = line.to - line.from;
  const auto size = static_cast<float>(length(along));
  const float thickness = thicker_ * tree.radii_mm[segment];
  Pieces pieces;
  // Short ones whole; of others pieces about as long as thick.
  if (size + 2 * thickness > finest_mm_)
    pieces.count = 1 + static_cast<int>(size / std::max(finest_mm_ / 2, 2 * thickness));
  const auto parts = static_cast<float>(pieces.count);
  const Vector3 middle = line.from + (0.5 / pieces.count) * along - origin_;
  pieces.first = {static_cast<float>(middle.x), static_cast<float>(middle.y),
                  static_cast<float>(middle.z), size / (2 * parts) + thickness + rounding_mm};
  pieces.step_x = static_cast<float>(along.x) / parts;
  pieces.step_y = static_cast<float>(along.y) / parts;
  pieces.step_z = static_cast<float>(along.z) / parts;
  return pieces;
}

std::size_t SegmentGrid::level_of(const Ball& ball) const {
  std::size_t level = 0;
  while (level + 1 < levels_.size() && levels_[level].cell_mm < 2 * ball.radius_mm)
    ++level;
  return level;
}

void SegmentGrid::add_levels(Vector3 extent, float widest_mm) {
  const double extents[3] = {extent.x, extent.y, extent.z};
  for (float cell = finest_mm_;; cell *= 2) {
    Level level;
    level.cell_mm = cell;
    level.per_mm = 1 / cell;
    for (int axis = 0; axis < 3; ++axis)
      level.size[axis] = 1 + static_cast<std::uint32_t>(extents[axis] / static_cast<double>(cell));
    level.first.resize(level.cell(0, 0, level.size[2]) + 2);
    levels_.push_back(std::move(level));
    if (cell >= widest_mm)
      return;
  }
}

SegmentGrid::SegmentGrid(const pipeline::VesselTree& tree, float thicker) : thicker_{thicker} {
  const auto nodes = static_cast<std::uint32_t>(tree.nodes());
  if (nodes == 0)
    return;
  Vector3 low{1e9, 1e9, 1e9};
  Vector3 high = -1.0 * low;
  for (std::uint32_t i = 0; i < nodes; ++i) {
    const Vector3 p = node_place(tree, i);
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  origin_ = low;
  finest_mm_ = finest_cell_mm(high - low, nodes);
  const auto with_each = [&](const auto& act) {
    for (std::uint32_t i = 0; i < nodes; ++i)
      if (tree.parents[i] != pipeline::no_parent)
        act(i, pieces_of(tree, i));
  };
  float widest = 0;
  with_each([&](std::uint32_t, const Pieces& pieces) {
    widest = std::max(widest, 2 * pieces.first.radius_mm);
  });
  add_levels(high - low, widest);
  // Counted into the cell after the next, summed up, and then put where the next one's begins.
  with_each([&](std::uint32_t, const Pieces& pieces) {
    Level& level = levels_[level_of(pieces.first)];
    for (int i = 0; i < pieces.count; ++i)
      ++level.first[level.cell_of(pieces.at(i)) + 2];
  });
  for (Level& level : levels_) {
    for (std::size_t i = 1; i < level.first.size(); ++i)
      level.first[i] += level.first[i - 1];
    level.items.resize(level.first.back());
  }
  with_each([&](std::uint32_t segment, const Pieces& pieces) {
    Level& level = levels_[level_of(pieces.first)];
    for (int i = 0; i < pieces.count; ++i)
      level.items[level.first[level.cell_of(pieces.at(i)) + 1]++] = {pieces.at(i), segment};
  });
}

void SegmentGrid::find_near(const pipeline::VesselTree& tree, std::uint32_t segment,
                            std::vector<std::uint32_t>& found) const {
  found.clear();
  const Pieces pieces = pieces_of(tree, segment);
  const std::size_t own = level_of(pieces.first);
  for (int i = 0; i < pieces.count; ++i)
    find_meeting(levels_[own], pieces.at(i), found);
  std::erase_if(found, [segment](std::uint32_t other) { return other >= segment; });
  for (int i = 0; i < pieces.count; ++i)
    for (std::size_t l = 0; l < own; ++l)
      find_meeting(levels_[l], pieces.at(i), found);
  std::ranges::sort(found);
  found.erase(std::ranges::unique(found).begin(), found.end());
}

void SegmentGrid::find_meeting(const Level& level, const Ball& ball,
                               std::vector<std::uint32_t>& found) {
  const float reach = ball.radius_mm + level.cell_mm / 2;
  const std::uint32_t first_x = level.index(ball.x - reach, 0);
  const std::uint32_t last_x = level.index(ball.x + reach, 0);
  const std::uint32_t first_y = level.index(ball.y - reach, 1);
  const std::uint32_t last_y = level.index(ball.y + reach, 1);
  const std::uint32_t last_z = level.index(ball.z + reach, 2);
  for (std::uint32_t z = level.index(ball.z - reach, 2); z <= last_z; ++z)
    for (std::uint32_t y = first_y; y <= last_y; ++y) {
      const std::uint32_t begin = level.first[level.cell(first_x, y, z)];
      const std::uint32_t end = level.first[level.cell(last_x, y, z) + 1];
      // Half of them meet: written without branches, which could not be foreseen.
      std::size_t count = found.size();
      found.resize(count + (end - begin));
      for (std::uint32_t i = begin; i < end; ++i) {
        found[count] = level.items[i].segment;
        count += meet(ball, level.items[i].ball);
      }
      found.resize(count);
    }
}

} // namespace octascope::sim
