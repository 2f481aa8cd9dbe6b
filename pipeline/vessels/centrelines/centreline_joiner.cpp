#include "pipeline/vessels/centrelines/centreline_joiner.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "pipeline/vessels/centrelines/centreline_graph.h"
#include "pipeline/vessels/centrelines/centreline_pieces.h"
#include "pipeline/vessels/centrelines/centreline_run.h"
#include "pipeline/vessels/centrelines/line_ends.h"

namespace octascope::pipeline {
namespace {

using Foot = CentrelineGraph::Foot;
using Node = CentrelineGraph::Node;
constexpr std::uint32_t none = CentrelineGraph::none;

// That a line is compared with where it begins, the newest first: else a star of lines would take the
// square of their number.
constexpr std::size_t most_ways_at_start = 256;

// Coordinates that went through single precision, a few times.
double precision_of(const Centrelines& lines) {
  double largest = 0;
  for (const auto& place : lines.positions_mm)
    for (const double c : place)
      largest = std::max(largest, std::fabs(c));
  return 8 * largest * 0x1p-24;
}

class Joiner {
public:
  explicit Joiner(const Centrelines& lines)
      : lines_{lines}, precision_{precision_of(lines)}, pieces_{lines}, ends_{lines, pieces_,
                                                                              precision_},
        node_of_(lines.positions_mm.size(), none),
        node_of_group_(ends_.groups(), none), follower_{graph_, precision_} {}

  JoinedCentrelines join() {
    for (const std::uint32_t piece : ends_.in_order())
      if (!insert(piece))
        return std::move(joined_);
    count_points();
    grow();
    return std::move(joined_);
  }

private:
  // Where an end of a line meets what is there already.
  std::vector<Foot> places_of(std::uint32_t end, std::uint64_t number) {
    const CentrelinePoint point = point_of(number);
    std::vector<Foot> places;
    const auto away_from = [&](Node node) {
      for (auto e = graph_.first_edge(node); e != none && places.size() < most_ways_at_start;
           e = graph_.next_edge(e))
        places.push_back(graph_.foot_on(e, point.position));
    };
    const std::uint32_t group = ends_.group_of(end);
    if (node_of_group_[group] != none) {
      away_from(node_of_group_[group]);
      return places;
    }
    const auto hit = ends_.on_line(group);
    if (!hit || node_of_[hit->point] == none)
      return places;
    const auto near = graph_.first_edge(node_of_[hit->point]);
    const Foot foot = graph_.look_around(near, point.position, hit->within_mm);
    return {foot, graph_.foot_on(foot.edge ^ 1U, point.position)};
  }

  // Along what is there, then on by itself. False where a loop closes.
  bool insert(std::uint32_t piece) {
    const std::span<const std::uint64_t> whole = pieces_[piece];
    if (whole.front() == whole.back())
      return tell_loop(whole.front());
    std::vector<std::uint64_t> points(whole.size());
    std::ranges::copy(whole, points.begin());
    auto start = places_of(2 * piece, whole.front());
    auto end = places_of(2 * piece + 1, whole.back());
    if (start.empty() && !end.empty()) {
      std::ranges::reverse(points);
      std::swap(start, end);
    }
    const bool numbered_end = node_of_[points.back()] != none;
    Node from = none;
    Node to = none;
    if (!start.empty())
      from = run_along(points, start);
    if (!points.empty() && from != none && !end.empty()) {
      if (!graph_.same_piece(from, graph_.beginning(end.front().edge))) {
        std::ranges::reverse(points);
        to = run_along(points, end);
        std::ranges::reverse(points);
      } else if (numbered_end) {
        return tell_loop(points.back());
      }
    }
    add_nodes(points, from, to);
    note_group(2 * piece, whole.front());
    note_group(2 * piece + 1, whole.back());
    return true;
  }

  void note_group(std::uint32_t end, std::uint64_t point) {
    Node& node = node_of_group_[ends_.group_of(end)];
    if (node == none)
      node = node_of_[point];
  }

  CentrelinePoint point_of(std::uint64_t point) const {
    return {lines_.positions_mm[point], lines_.radii_mm[point]};
  }

  // Takes away the points that are others' already; the node that the rest goes on from.
  Node run_along(std::vector<std::uint64_t>& points, std::span<const Foot> start) {
    line_.clear();
    for (const std::uint64_t point : points)
      line_.push_back(point_of(point));
    const auto note = [&](std::size_t i, const Foot& foot) {
      if (node_of_[points[i]] == none)
        node_of_[points[i]] = graph_.nearer_end(foot);
    };
    note(0, *std::ranges::min_element(start, {}, &Foot::distance));
    const CentrelineRun run = follower_.follow(line_, start, note);
    const Node fork =
        run.own == points.size() ? graph_.nearer_end(run.fork) : graph_.node_at(run.fork);
    const auto others = points.begin() + static_cast<std::ptrdiff_t>(run.own);
    for (auto point = points.begin(); point != others; ++point)
      if (node_of_[*point] == none)
        node_of_[*point] = fork;
    points.erase(points.begin(), others);
    return fork;
  }

  void add_nodes(std::span<const std::uint64_t> points, Node from, Node to) {
    for (const std::uint64_t point : points) {
      const CentrelinePoint p = point_of(point);
      if (from != none && graph_.position(from) == p.position) {
        node_of_[point] = from;
        continue;
      }
      const Node node = graph_.add_node(p.position, p.radius);
      if (from != none)
        graph_.connect(from, node);
      node_of_[point] = from = node;
    }
    if (to != none)
      graph_.connect(from, to);
  }

  bool tell_loop(std::uint64_t point) {
    const auto& p = lines_.positions_mm[point];
    joined_.loop = fmt::format("point {} at ({:g}, {:g}, {:g}) mm", point, p[0], p[1], p[2]);
    return false;
  }

  // What VTP counts: each point that a line goes through is a node or another's place.
  void count_points() {
    std::vector<bool> used(node_of_.size(), false);
    std::uint64_t begin = 0;
    for (const std::uint64_t end : lines_.ends) {
      joined_.short_lines += end - begin < 2 ? 1U : 0U;
      begin = end;
    }
    for (const std::uint64_t point : lines_.points)
      used[point] = true;
    const auto in_lines = static_cast<std::uint64_t>(std::ranges::count(used, true));
    joined_.unused_points = used.size() - in_lines;
    joined_.merged_points = in_lines - graph_.nodes();
  }

  // By piece of the graph: where its lines begin and end.
  struct Mouths {
    Node first_start = none, first_end = none;
    bool one_start = true, one_end = true;
  };

  void grow() {
    const std::size_t nodes = graph_.nodes();
    std::vector<bool> led_to(nodes, false); // by a line, from somewhere
    std::vector<Mouths> mouths(nodes);
    std::vector<Node> starts;
    std::uint64_t begin = 0;
    for (const std::uint64_t end : lines_.ends) {
      Node start = none;
      Node last = none;
      for (; begin < end; ++begin) {
        const Node node = node_of_[lines_.points[begin]];
        if (node == none) // of a piece without length
          continue;
        if (start == none)
          start = node;
        else if (node != last)
          led_to[node] = true;
        last = node;
      }
      if (start == none)
        continue;
      starts.push_back(start);
      Mouths& of_piece = mouths[graph_.piece_of(start)];
      note_mouth(of_piece.first_start, of_piece.one_start, start);
      note_mouth(of_piece.first_end, of_piece.one_end, last);
    }
    place_.assign(nodes, none);
    // First from where all lines lead to; then from where lines begin and none leads to; then what
    // is left: lines that run against each other.
    for (const Node start : starts)
      if (const Mouths& m = mouths[graph_.piece_of(start)];
          m.one_end && !m.one_start && place_[m.first_end] == none)
        grow_from(m.first_end);
    for (const bool only_mouths : {true, false})
      for (const Node start : starts)
        if (place_[start] == none && !(only_mouths && led_to[start]))
          grow_from(start);
  }

  static void note_mouth(Node& first, bool& one, Node mouth) {
    if (first == none)
      first = mouth;
    one = one && mouth == first;
  }

  void grow_from(Node root) {
    VesselTree& tree = joined_.tree;
    std::vector<std::pair<Node, std::uint32_t>> open{{root, no_parent}}; // with its parent's place
    std::vector<Node> onward;
    while (!open.empty()) {
      const auto [node, parent] = open.back();
      open.pop_back();
      const auto place = static_cast<std::uint32_t>(tree.nodes());
      const auto& p = graph_.position(node);
      tree.positions_mm.push_back(
          {static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])});
      tree.radii_mm.push_back(static_cast<float>(graph_.radius(node)));
      tree.parents.push_back(parent);
      tree.branches.push_back(VesselBranch::unknown);
      place_[node] = place;
      onward.clear();
      for (auto e = graph_.first_edge(node); e != none; e = graph_.next_edge(e))
        if (place_[graph_.end(e)] == none)
          onward.push_back(graph_.end(e));
      std::ranges::sort(onward, std::greater{});
      for (const Node next : onward)
        open.emplace_back(next, place);
    }
  }

  const Centrelines& lines_;
  double precision_;
  CentrelinePieces pieces_;
  LineEnds ends_;
  CentrelineGraph graph_;
  std::vector<Node> node_of_;       // of each point: that it became, or that is about there
  std::vector<Node> node_of_group_; // of line ends
  CentrelineFollower follower_;
  std::vector<CentrelinePoint> line_;
  std::vector<std::uint32_t> place_; // of each node, in the tree
  JoinedCentrelines joined_;
};

} // namespace

JoinedCentrelines join_centrelines(const Centrelines& lines) {
  return Joiner{lines}.join();
}

} // namespace octascope::pipeline
