// The vessels while their centrelines are being joined: an undirected graph without loops.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "pipeline/vessels/centrelines/segment_geometry.h"

namespace octascope::pipeline {

class CentrelineGraph {
public:
  using Node = std::uint32_t;
  using Edge = std::uint32_t; // with a direction; its reverse is `edge ^ 1`
  static constexpr std::uint32_t none = 0xFFFFFFFF;

  // The place on an edge that is nearest to some point.
  struct Foot {
    Edge edge = none;
    double along = 0; // 0 at its beginning to 1 at its end
    double distance = 0;
  };

  Node add_node(const Position& position, double radius);
  // The two must be in different pieces, else this closes a loop.
  void connect(Node a, Node b);
  // The node at that place: an end of the edge if it is near, else a new node that splits the edge.
  Node node_at(const Foot& place);

  std::size_t nodes() const { return positions_.size(); }
  const Position& position(Node node) const { return positions_[node]; }
  double radius(Node node) const { return radii_[node]; }
  bool same_piece(Node a, Node b) { return piece_of(a) == piece_of(b); }
  Node piece_of(Node node); // one node of each connected piece stands for it

  Node beginning(Edge edge) const { return edges_[edge ^ 1U].to; }
  Node end(Edge edge) const { return edges_[edge].to; }
  double length(Edge edge) const { return edges_[edge].length; }
  Node nearer_end(const Foot& foot) const {
    return foot.along < 0.5 ? beginning(foot.edge) : end(foot.edge);
  }
  bool is_tip(const Foot& foot) const {
    return foot.along == 1 && next_edge(first_edge(end(foot.edge))) == none;
  }
  double radius_at(const Foot& foot) const;
  Foot foot_on(Edge edge, const Position& point) const;

  // Edges that leave a node: for (e = first_edge(node); e != none; e = next_edge(e)).
  Edge first_edge(Node node) const { return first_[node]; }
  Edge next_edge(Edge edge) const { return edges_[edge].next; }

  // Appends the nearest place ahead of the beginning of `from`, for a point that is `step` farther on;
  // after a fork, one place on each branch.
  void look_ahead(Edge from, const Position& point, double step, std::vector<Foot>& found) const;

  // The nearest place on an edge and its surroundings, up to `reach` along the vessels.
  Foot look_around(Edge middle, const Position& point, double reach) const;

private:
  struct HalfEdge {
    Node to;
    Edge next;
    double length;
  };

  void look_ahead(Edge from, const Position& point, double reach, int& budget,
                  std::vector<Foot>& found) const;
  void add_half_edge(Node from, Node to, double length);

  std::vector<Position> positions_;
  std::vector<double> radii_;
  std::vector<Edge> first_;
  std::vector<Node> pieces_; // a forest of nodes; its roots stand for pieces
  std::vector<HalfEdge> edges_;
};

} // namespace octascope::pipeline
