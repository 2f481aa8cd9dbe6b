#include "pipeline/vessels/centrelines/centreline_graph.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace octascope::pipeline {
namespace {

// Bounds the work where lines have very many points in a radius.
constexpr int most_edges_ahead = 64;
constexpr int most_edges_around = 1024;

} // namespace

CentrelineGraph::Node CentrelineGraph::add_node(const Position& position, double radius) {
  const auto node = static_cast<Node>(nodes());
  positions_.push_back(position);
  radii_.push_back(radius);
  first_.push_back(none);
  pieces_.push_back(node);
  return node;
}

void CentrelineGraph::add_half_edge(Node from, Node to, double length) {
  edges_.push_back({to, first_[from], length});
  first_[from] = static_cast<Edge>(edges_.size() - 1);
}

void CentrelineGraph::connect(Node a, Node b) {
  const double length = distance(positions_[a], positions_[b]);
  add_half_edge(a, b, length);
  add_half_edge(b, a, length);
  pieces_[piece_of(b)] = piece_of(a);
}

CentrelineGraph::Node CentrelineGraph::piece_of(Node node) {
  while (pieces_[node] != node)
    node = pieces_[node] = pieces_[pieces_[node]];
  return node;
}

double CentrelineGraph::radius_at(const Foot& foot) const {
  return std::lerp(radii_[beginning(foot.edge)], radii_[end(foot.edge)], foot.along);
}

CentrelineGraph::Foot CentrelineGraph::foot_on(Edge edge, const Position& point) const {
  const Position& a = positions_[beginning(edge)];
  const Position& b = positions_[end(edge)];
  const double along = nearest_share(a, b, point);
  return {edge, along, distance(between(a, b, along), point)};
}

CentrelineGraph::Node CentrelineGraph::node_at(const Foot& place) {
  constexpr double near_end = 0.05; // of the edge
  const Node from = beginning(place.edge);
  const Node to = end(place.edge);
  if (place.along <= near_end)
    return from;
  if (place.along >= 1 - near_end)
    return to;
  const Node middle =
      add_node(between(positions_[from], positions_[to], place.along), radius_at(place));
  pieces_[middle] = piece_of(from);
  // The edge now ends in the middle; a new one goes on from there, in the old one's place at `to`.
  const double whole = length(place.edge);
  const Edge back = place.edge ^ 1U;
  const auto onward = static_cast<Edge>(edges_.size());
  edges_.push_back({to, none, (1 - place.along) * whole});
  edges_.push_back({middle, edges_[back].next, (1 - place.along) * whole});
  Edge* link = &first_[to];
  while (*link != back)
    link = &edges_[*link].next;
  *link = onward ^ 1U;
  edges_[place.edge].to = middle;
  edges_[place.edge].length = edges_[back].length = place.along * whole;
  edges_[back].next = onward;
  first_[middle] = back;
  return middle;
}

void CentrelineGraph::look_ahead(Edge from, const Position& point, double step,
                                 std::vector<Foot>& found) const {
  // Beyond a corner that the point cuts, the line comes nearer again only after twice its distance.
  const double reach = step + 2 * foot_on(from, point).distance;
  int budget = most_edges_ahead;
  look_ahead(from, point, reach, budget, found);
}

void CentrelineGraph::look_ahead(Edge from, const Position& point, double reach, int& budget,
                                 std::vector<Foot>& found) const {
  Foot best = foot_on(from, point);
  double left = reach - (1 - best.along) * length(from);
  for (Edge edge = from; left >= 0 && --budget > 0;) {
    const Edge back = edge ^ 1U;
    Edge onward = none;
    int ways = 0;
    for (Edge e = first_edge(end(edge)); e != none; e = next_edge(e)) {
      if (e == back)
        continue;
      onward = e;
      if (++ways > 1)
        break;
    }
    if (ways == 0)
      break;
    if (ways > 1) {
      const std::size_t before = found.size();
      for (Edge e = first_edge(end(edge)); e != none && budget > 0; e = next_edge(e))
        if (e != back)
          look_ahead(e, point, left, --budget, found);
      const bool passed =
          std::any_of(found.begin() + static_cast<std::ptrdiff_t>(before), found.end(),
                      [&](const Foot& foot) { return foot.distance <= best.distance; });
      if (passed)
        return;
      found.resize(before);
      break;
    }
    if (const Foot next = foot_on(onward, point); next.distance <= best.distance)
      best = next;
    left -= length(onward);
    edge = onward;
  }
  found.push_back(best);
}

CentrelineGraph::Foot CentrelineGraph::look_around(Edge middle, const Position& point,
                                                   double reach) const {
  Foot best = foot_on(middle, point);
  std::vector<std::pair<Edge, double>> open{{middle, reach}, {middle ^ 1U, reach}};
  for (int budget = most_edges_around; !open.empty() && budget > 0; --budget) {
    const auto [edge, left] = open.back();
    open.pop_back();
    for (Edge e = first_edge(end(edge)); e != none; e = next_edge(e)) {
      if (e == (edge ^ 1U))
        continue;
      if (const Foot foot = foot_on(e, point); foot.distance < best.distance)
        best = foot;
      if (left > length(e))
        open.emplace_back(e, left - length(e));
    }
  }
  return best;
}

} // namespace octascope::pipeline
