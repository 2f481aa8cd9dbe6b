#include "pipeline/vessels/centrelines/centreline_run.h"

#include <algorithm>
#include <cmath>

namespace octascope::pipeline {
namespace {

using Foot = CentrelineGraph::Foot;

constexpr double together_within = 0.25; // of the smaller radius
// In such distances: where the direction in which a line leaves is known, how long that may take,
// and how far back the fork may be.
constexpr double clear_beyond = 8;
constexpr double longest_leave = 64;
constexpr double farthest_fork = 32;
constexpr std::size_t most_ways = 64;
constexpr double most_steps = 16; // between two points

CentrelinePoint between(const CentrelinePoint& a, const CentrelinePoint& b, double share) {
  return {pipeline::between(a.position, b.position, share), std::lerp(a.radius, b.radius, share)};
}

} // namespace

double CentrelineFollower::limit_at(const CentrelinePoint& point, const Foot& foot) const {
  return std::max(together_within * std::min(point.radius, graph_.radius_at(foot)), precision_);
}

// Moves along all ways and gives up those that the point is too far from. The nearest, which stays
// even so.
Foot CentrelineFollower::advance(const CentrelinePoint& point, double step, bool parted) {
  found_.clear();
  for (const Foot& way : ways_)
    graph_.look_ahead(way.edge, point.position, step, found_);
  const Foot nearest = *std::ranges::min_element(found_, {}, &Foot::distance);
  ways_.clear();
  for (const Foot& way : found_)
    if (!parted && way.distance <= limit_at(point, way) && ways_.size() < most_ways)
      ways_.push_back(way);
  if (ways_.empty())
    ways_.push_back(nearest);
  return nearest;
}

// Where on its way the line's distance from the vessel would have begun, had it always grown as
// fast as where it grows the fastest.
double CentrelineFollower::fork_of(double limit) const {
  const double last = leaving_.front().travelled;
  double steepest = 0;
  double fork = last;
  std::size_t from = 0;
  for (std::size_t i = 1; i < leaving_.size(); ++i) {
    while (from + 1 < i && leaving_[i].travelled - leaving_[from + 1].travelled >= limit)
      ++from;
    const double slope = (leaving_[i].distance - leaving_[from].distance) /
                         std::max(leaving_[i].travelled - leaving_[from].travelled, 1e-300);
    if (slope > steepest) {
      steepest = slope;
      fork = leaving_[i].travelled - leaving_[i].distance / slope;
    }
  }
  return std::clamp(fork, std::max(last - farthest_fork * limit, 0.0), last);
}

CentrelineRun CentrelineFollower::follow(std::span<const CentrelinePoint> line,
                                         std::span<const Foot> start,
                                         const std::function<void(std::size_t, Foot)>& on) {
  ways_.assign(start.begin(), start.end());
  Foot near = *std::ranges::min_element(start, {}, &Foot::distance);
  leaving_.assign(1, {0, near.distance});
  travelled_.assign(1, 0);
  double limit = limit_at(line[0], near);
  std::size_t last = 0; // point on the vessel
  bool parted = false;
  bool clear = false;
  for (std::size_t i = 1; i < line.size() && !clear; ++i) {
    const double length = distance(line[i - 1].position, line[i].position);
    const double steps = std::clamp(std::ceil(length / limit), 1.0, most_steps);
    for (double step = 1; step <= steps && !clear; ++step) {
      const CentrelinePoint point =
          step < steps ? between(line[i - 1], line[i], step / steps) : line[i];
      const double travelled = travelled_.back() + length * step / steps;
      const Foot foot = advance(point, length / steps, parted);
      if (!parted) {
        limit = limit_at(point, foot);
        parted = foot.distance > limit;
      }
      if (parted) {
        // Where it comes nearer again, it passes another vessel.
        if (foot.distance < 0.9 * leaving_.back().distance) {
          clear = true;
          break;
        }
        leaving_.push_back({travelled, foot.distance});
        // Beyond a tip the distance grows with the line's length, whatever their directions.
        clear = graph_.is_tip(foot) || foot.distance > clear_beyond * limit ||
                travelled - leaving_.front().travelled > longest_leave * limit;
      } else {
        near = foot;
        leaving_.assign(1, {travelled, foot.distance});
      }
    }
    travelled_.push_back(travelled_.back() + length);
    if (!parted) {
      last = i;
      on(i, near);
    }
  }
  if (!parted)
    return {line.size(), near};
  const double fork = last == 0 ? 0 : fork_of(limit); // what leaves at once began there
  const auto first_behind = [&](double travelled, double part_of_step) {
    std::size_t i = 1;
    while (i + 1 < travelled_.size() &&
           travelled_[i] - travelled <= part_of_step * (travelled_[i] - travelled_[i - 1]))
      ++i;
    return i;
  };
  const std::size_t i = first_behind(fork, 0);
  const double step = std::max(travelled_[i] - travelled_[i - 1], 1e-300);
  const Position place = pipeline::between(line[i - 1].position, line[i].position,
                                           std::min((fork - travelled_[i - 1]) / step, 1.0));
  const Sample& parting = leaving_.front();
  const Foot foot = graph_.look_around(near.edge, place,
                                       std::fabs(parting.travelled - fork) + 2 * parting.distance);
  // Not there, where smoothing has bent the line away from the vessel before its fork: the way back
  // to the vessel would be too long.
  constexpr double bent = 0.1; // of the limit
  if (foot.distance > bent * limit)
    return {first_behind(parting.travelled, 0), near};
  constexpr double at_once = 0.05; // of a step: no point of its own so near to the fork
  return {first_behind(fork, at_once), foot};
}

} // namespace octascope::pipeline
