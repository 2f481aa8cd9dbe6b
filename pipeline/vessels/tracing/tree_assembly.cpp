#include "pipeline/vessels/tracing/tree_assembly.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "pipeline/vessels/vectors.h"
#include "pipeline/vessels/vessel_orders.h"

namespace octascope::pipeline {

namespace {

// Lines by points and what they are joined to, without a direction.
struct LineGraph {
  std::vector<Point> points;
  std::vector<double> radii;
  std::vector<std::vector<std::uint32_t>> joined;
  std::vector<std::uint32_t> tree; // of each point, by its first line

  // The end and up to three points before it, as far as nothing forks.
  std::vector<std::uint32_t> before_end(std::uint32_t end) const {
    std::vector<std::uint32_t> run{end, joined[end][0]};
    while (run.size() < 4 && joined[run.back()].size() == 2)
      run.push_back(joined[run.back()][joined[run.back()][0] == run[run.size() - 2] ? 1 : 0]);
    return run;
  }

  void join(std::uint32_t a, std::uint32_t b) {
    joined[a].push_back(b);
    joined[b].push_back(a);
  }
};

// The first line of what each is connected to.
std::vector<std::uint32_t> trees_of(const std::vector<VesselLine>& lines) {
  std::vector<std::uint32_t> trees(lines.size());
  for (std::uint32_t l = 0; l < lines.size(); ++l)
    trees[l] = lines[l].from == VesselLine::no_line ? l : trees[lines[l].from];
  return trees;
}

// Where a line seems to come from on the one that it leaves.
std::size_t fork_of(const VesselLine& line, const VesselLine& from) {
  const Point back = direction(difference(line.points[0], line.points[1]));
  const double apart = length(difference(line.points[0], from.points[line.fork]));
  return nearest_point(from, sum(line.points[0], scaled(back, apart)));
}

LineGraph graph_of(const std::vector<VesselLine>& lines) {
  LineGraph graph;
  const std::vector<std::uint32_t> trees = trees_of(lines);
  std::vector<std::uint32_t> first;
  for (std::size_t l = 0; l < lines.size(); ++l) {
    const VesselLine& line = lines[l];
    first.push_back(static_cast<std::uint32_t>(graph.points.size()));
    graph.points.insert(graph.points.end(), line.points.begin(), line.points.end());
    graph.radii.insert(graph.radii.end(), line.radii.begin(), line.radii.end());
    graph.joined.resize(graph.points.size());
    graph.tree.resize(graph.points.size(), trees[l]);
    for (std::uint32_t i = 1; i < line.points.size(); ++i)
      graph.join(first[l] + i - 1, first[l] + i);
    if (line.from != VesselLine::no_line)
      graph.join(first[l],
                 first[line.from] + static_cast<std::uint32_t>(fork_of(line, lines[line.from])));
  }
  return graph;
}

struct Bridge {
  double gap_um;
  std::uint32_t a, b;
};

std::vector<Bridge> bridges_of(const LineGraph& graph, double widest_um) {
  std::vector<std::uint32_t> ends;
  for (std::uint32_t point = 0; point < graph.points.size(); ++point)
    if (graph.joined[point].size() == 1)
      ends.push_back(point);
  std::ranges::sort(ends, {}, [&](std::uint32_t end) { return graph.points[end][0]; });
  const double reach = std::max(4 * std::ranges::max(graph.radii), 3 * widest_um);
  const auto outwards = [&](std::uint32_t end) {
    return direction(difference(graph.points[end], graph.points[graph.before_end(end).back()]));
  };
  constexpr double straight = 0.8; // cosine
  std::vector<Bridge> bridges;
  for (std::size_t i = 0; i < ends.size(); ++i)
    for (std::size_t j = i + 1; j < ends.size(); ++j) {
      const std::uint32_t a = ends[i];
      const std::uint32_t b = ends[j];
      const Point gap = difference(graph.points[b], graph.points[a]);
      if (gap[0] > reach)
        break;
      const double thin = std::min(graph.radii[a], graph.radii[b]);
      const double thick = std::max(graph.radii[a], graph.radii[b]);
      if (graph.tree[a] == graph.tree[b] || thick > 2 * thin ||
          length(gap) > std::max(4 * thin, 3 * widest_um))
        continue;
      const Point way = direction(gap);
      if (product(way, outwards(a)) > straight && product(way, outwards(b)) < -straight)
        bridges.push_back({length(gap), a, b});
    }
  std::ranges::sort(bridges, {}, [](const Bridge& of) { return std::pair{of.gap_um, of.a}; });
  return bridges;
}

// Shortest first, each end once, and no loops.
void bridge_gaps(LineGraph& graph, double widest_um) {
  std::vector<std::uint32_t> whole(graph.points.size()); // tree that a tree became part of
  std::iota(whole.begin(), whole.end(), 0U);
  const auto tree_of = [&](std::uint32_t point) {
    std::uint32_t tree = graph.tree[point];
    while (whole[tree] != tree)
      tree = whole[tree];
    return tree;
  };
  for (const Bridge& bridge : bridges_of(graph, widest_um)) {
    const bool used = graph.joined[bridge.a].size() > 1 || graph.joined[bridge.b].size() > 1;
    if (used || tree_of(bridge.a) == tree_of(bridge.b))
      continue;
    whole[tree_of(bridge.a)] = tree_of(bridge.b);
    graph.join(bridge.a, bridge.b);
  }
}

// Of the unvisited ones: ends from the widest to the thinnest. Every tree has one.
std::vector<std::uint32_t> roots_of(const LineGraph& graph) {
  std::vector<std::uint32_t> ends;
  for (std::uint32_t point = 0; point < graph.points.size(); ++point)
    if (graph.joined[point].size() == 1)
      ends.push_back(point);
  const auto width = [&](std::uint32_t end) {
    double radii = 0;
    const std::vector<std::uint32_t> run = graph.before_end(end);
    for (const std::uint32_t point : run)
      radii += graph.radii[point];
    return radii / static_cast<double>(run.size());
  };
  std::ranges::stable_sort(ends, std::ranges::greater{}, width);
  return ends;
}

VesselTree tree_of(const LineGraph& graph) {
  constexpr double mm = 1e-3;
  VesselTree tree;
  std::vector<bool> visited(graph.points.size());
  std::vector<std::pair<std::uint32_t, std::uint32_t>> waiting; // point, parent's node
  for (const std::uint32_t root : roots_of(graph)) {
    if (visited[root])
      continue;
    waiting.emplace_back(root, no_parent);
    visited[root] = true;
    while (!waiting.empty()) {
      const auto [point, parent] = waiting.back();
      waiting.pop_back();
      const auto node = static_cast<std::uint32_t>(tree.nodes());
      const Point& at = graph.points[point];
      tree.positions_mm.push_back({static_cast<float>(at[0] * mm), static_cast<float>(at[1] * mm),
                                   static_cast<float>(at[2] * mm)});
      tree.radii_mm.push_back(static_cast<float>(graph.radii[point] * mm));
      tree.parents.push_back(parent);
      for (const std::uint32_t next : graph.joined[point])
        if (!visited[next]) {
          visited[next] = true;
          waiting.emplace_back(next, node);
        }
    }
  }
  tree.branches.assign(tree.nodes(), VesselBranch::unknown);
  assign_vessel_orders(tree);
  return tree;
}

} // namespace

void drop_short(std::vector<VesselLine>& lines, const FlowGrid& grid) {
  struct Extent {
    double length = 0;
    double radius = 0; // the mean, times the length
  };
  const std::vector<std::uint32_t> trees = trees_of(lines);
  std::vector<Extent> extents(lines.size());
  for (std::size_t l = 0; l < lines.size(); ++l)
    for (std::size_t i = 1; i < lines[l].points.size(); ++i) {
      const double step = length(difference(lines[l].points[i], lines[l].points[i - 1]));
      extents[trees[l]].length += step;
      extents[trees[l]].radius += step * lines[l].radii[i];
    }
  std::vector<VesselLine> kept;
  std::vector<std::uint32_t> place(lines.size(), VesselLine::no_line);
  for (std::size_t l = 0; l < lines.size(); ++l) {
    const Extent& of = extents[trees[l]];
    if (of.length * of.length < 4 * of.radius || of.length < 3 * grid.widest_um())
      continue;
    place[l] = static_cast<std::uint32_t>(kept.size());
    if (lines[l].from != VesselLine::no_line)
      lines[l].from = place[lines[l].from];
    kept.push_back(std::move(lines[l]));
  }
  lines = std::move(kept);
}

VesselTree assemble_tree(const std::vector<VesselLine>& lines, const FlowGrid& grid) {
  LineGraph graph = graph_of(lines);
  bridge_gaps(graph, grid.widest_um());
  return tree_of(graph);
}

} // namespace octascope::pipeline
