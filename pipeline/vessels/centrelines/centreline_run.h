// How far a centreline runs along vessels that are there already, and where it leaves them.
//
// Copies of one vessel differ by rounding, resampling and smoothing, a small part of its radius;
// two vessels side by side are apart by the sum of theirs. A line that begins on a vessel therefore
// runs along it until they are a quarter of a radius apart, and from there on it is another vessel.
// Where the two fork is estimated from how they part: smoothing bends them apart too early.
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
  std::size_t own = 0; // its first point that is no vessel's; their number where it never leaves
  CentrelineGraph::Foot
      fork; // from where on the vessel it goes there; where it ends, if it never leaves
};

class CentrelineFollower {
public:
  // Borrows the graph. Distances below `precision` are rounding.
  CentrelineFollower(const CentrelineGraph& graph, double precision)
      : graph_{graph}, precision_{precision} {}

  // `line` from one of its ends on. `start`: the ways that it may take, each with the place of its
  // first point; at least one. Calls on(index, place) for each further point that is on a vessel.
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
