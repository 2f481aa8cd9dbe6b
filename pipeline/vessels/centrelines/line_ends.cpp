#include "pipeline/vessels/centrelines/line_ends.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>
#include <utility>

#include "pipeline/vessels/centrelines/point_index.h"
#include "pipeline/vessels/centrelines/segment_geometry.h"

namespace octascope::pipeline {
LineEnds::LineEnds(const Centrelines& lines, const CentrelinePieces& pieces, double precision)
    : lines_{lines}, pieces_{pieces}, precision_{precision} {
  gather_groups();
  on_line_.resize(representative_.size());
  if (!all_joined())
    find_on_lines();
}

double LineEnds::reach_of(std::uint64_t point) const {
  return std::max(end_within_radii * lines_.radii_mm[point], precision_);
}

void LineEnds::gather_groups() {
  const auto ends = static_cast<std::uint32_t>(2 * pieces_.size());
  std::vector<Position> positions;
  for (std::uint32_t end = 0; end < ends; ++end)
    positions.push_back(lines_.positions_mm[point_at(end)]);
  const PointIndex index{positions};
  group_.assign(ends, no_parent);
  for (std::uint32_t end = 0; end < ends; ++end) {
    if (group_[end] != no_parent)
      continue;
    const auto group = static_cast<std::uint32_t>(representative_.size());
    representative_.push_back(end);
    const double reach = reach_of(point_at(end));
    index.for_each_near(positions[end], positions[end], reach, [&](std::uint32_t other) {
      if (group_[other] == no_parent &&
          distance(positions[end], positions[other]) <= std::min(reach, reach_of(point_at(other))))
        group_[other] = group;
    });
  }
}

bool LineEnds::all_joined() const {
  std::vector<std::uint32_t> joined(representative_.size());
  std::iota(joined.begin(), joined.end(), 0U);
  const auto find = [&](std::uint32_t group) {
    while (joined[group] != group)
      group = joined[group] = joined[joined[group]];
    return group;
  };
  std::size_t parts = joined.size();
  for (std::uint32_t end = 0; end < group_.size(); end += 2) {
    const std::uint32_t a = find(group_[end]);
    const std::uint32_t b = find(group_[end + 1]);
    parts -= a != b ? 1 : 0;
    joined[a] = b;
  }
  return parts <= 1;
}

void LineEnds::find_on_lines() {
  std::vector<Position> places;
  double farthest = 0;
  for (const std::uint32_t end : representative_) {
    places.push_back(lines_.positions_mm[point_at(end)]);
    farthest = std::max(farthest, reach_of(point_at(end)));
  }
  const PointIndex index{places};
  for (std::uint32_t piece = 0; piece < pieces_.size(); ++piece) {
    const auto points = pieces_[piece];
    for (std::size_t i = 1; i < points.size(); ++i) {
      const Position& a = lines_.positions_mm[points[i - 1]];
      const Position& b = lines_.positions_mm[points[i]];
      Position lowest{};
      Position highest{};
      for (std::size_t axis = 0; axis < 3; ++axis)
        std::tie(lowest[axis], highest[axis]) = std::minmax(a[axis], b[axis]);
      const double reach = std::max(reach_of(points[i - 1]), reach_of(points[i]));
      index.for_each_near(lowest, highest, std::min(reach, farthest), [&](std::uint32_t group) {
        if (group == group_[2 * piece] || group == group_[2 * piece + 1])
          return;
        const double share = nearest_share(a, b, places[group]);
        const double away = distance(places[group], between(a, b, share));
        const double on_line = std::lerp(reach_of(points[i - 1]), reach_of(points[i]), share);
        std::optional<OnLine>& found = on_line_[group];
        if (away <= std::min(on_line, reach_of(point_at(representative_[group]))) &&
            (!found || away < found->distance_mm))
          found = OnLine{piece, points[i - 1], away, distance(a, b) + 2 * reach};
      });
    }
  }
}

std::vector<std::uint32_t> LineEnds::in_order() const {
  enum class State : std::uint8_t { unseen, waiting, placed };
  std::vector<State> states(pieces_.size(), State::unseen);
  std::vector<std::uint32_t> order;
  std::vector<std::uint32_t> open;
  for (std::uint32_t first = 0; first < pieces_.size(); ++first) {
    open.push_back(first);
    while (!open.empty()) {
      const std::uint32_t piece = open.back();
      if (states[piece] == State::unseen) {
        states[piece] = State::waiting;
        for (const std::uint32_t end : {2 * piece, 2 * piece + 1})
          if (const auto& on = on_line_[group_[end]]; on && states[on->piece] == State::unseen)
            open.push_back(on->piece);
        continue;
      }
      open.pop_back();
      if (std::exchange(states[piece], State::placed) != State::placed)
        order.push_back(piece);
    }
  }
  return order;
}

} // namespace octascope::pipeline
