// Finds how far a centreline runs along existing vessels, and where it leaves them.
//
// Copies of one vessel differ by rounding, resampling and smoothing: a small part of its radius.
// Two vessels side by side are as far apart as the sum of their radii. So a line that begins on a
// vessel runs along it until the two are a quarter of a radius apart; beyond that it is another
// vessel. As smoothing bends them apart too early, the fork is estimated from how their distance
// grows.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "pipeline/vessels/centrelines/centreline_graph.h"

namespace octascope::pipeline {

struct CentrelinePoint {
  Position position{};
  double radius = 0;
};

struct CentrelineRun {
  std::size_t own = 0;        // its first point beyond the vessels; the number of points if none is
  CentrelineGraph::Foot fork; // where it leaves the vessel, or ends on it
};

class CentrelineFollower {
public:
  // Borrows the graph. Distances below `precision` count as rounding.
  CentrelineFollower(const CentrelineGraph& graph, double precision)
      : graph_{graph}, precision_{precision} {}

  // Follows `line` from its first point. `start` has the edges that it may take, at least one, each
  // with the place of that point. Calls on(index, place) for each further point on a vessel.
  CentrelineRun follow(std::span<const CentrelinePoint> line,
                       std::span<const CentrelineGraph::Foot> start,
                       const std::function<void(std::size_t, CentrelineGraph::Foot)>& on);

private:
  struct Sample {
    double travelled;
    double distance;
  };

  double limit_at(const CentrelinePoint& point, const CentrelineGraph::Foot& foot) const;
  CentrelineGraph::Foot advance(const CentrelinePoint& point, double step, bool parted);
  double fork_of(double limit) const;

  const CentrelineGraph& graph_;
  double precision_;
  std::vector<CentrelineGraph::Foot> ways_, found_;
  std::vector<double> travelled_; // to each point of the line
  std::vector<Sample> leaving_;   // from the last place on the vessel
};

} // namespace octascope::pipeline
