#include "pipeline/vessels/files/centreline_joiner.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>

namespace octascope::pipeline {
namespace {

using Place = std::array<double, 3>;
using Cell = std::array<std::int64_t, 3>;

struct CellHash {
  std::size_t operator()(const Cell& cell) const {
    std::uint64_t hash = 0;
    for (const std::int64_t c : cell) {
      hash = (hash ^ static_cast<std::uint64_t>(c)) * 0x9E3779B97F4A7C15U;
      hash ^= hash >> 29;
    }
    return hash;
  }
};

// Finds places that were there before, within a tolerance: a grid of cells of that width.
class PlaceFinder {
public:
  PlaceFinder(const std::vector<Place>& places, double within)
      : places_{places}, within_{within}, next_(places.size(), no_parent) {}

  // The first point before this one that is near enough, else this one.
  std::uint32_t find_or_add(std::uint32_t point) {
    const Cell centre = cell_of(places_[point]);
    for (std::int64_t i = 0; i < 27; ++i) {
      const Cell cell{centre[0] + i % 3 - 1, centre[1] + i / 3 % 3 - 1, centre[2] + i / 9 - 1};
      const auto found = first_.find(cell);
      if (found == first_.end())
        continue;
      for (std::uint32_t other = found->second; other != no_parent; other = next_[other]) {
        if (near(places_[other], places_[point]))
          return other;
      }
    }
    const auto [entry, added] = first_.try_emplace(centre, point);
    if (!added)
      next_[point] = std::exchange(entry->second, point);
    return point;
  }

private:
  // Cells must not be so small that their numbers leave 64 bits.
  Cell cell_of(const Place& place) const {
    constexpr double smallest_cell_mm = 1e-6;
    const double width = std::max(within_, smallest_cell_mm);
    Cell cell{};
    for (std::size_t axis = 0; axis < 3; ++axis)
      cell[axis] = static_cast<std::int64_t>(std::floor(place[axis] / width));
    return cell;
  }
  bool near(const Place& a, const Place& b) const {
    return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]) <= within_;
  }

  const std::vector<Place>& places_;
  double within_;
  std::vector<std::uint32_t> next_; // point of the same cell
  std::unordered_map<Cell, std::uint32_t, CellHash> first_;
};

class Joiner {
public:
  Joiner(const Centrelines& lines, double within_mm)
      : lines_{lines}, nodes_(lines.positions_mm.size(), no_parent),
        led_to_(lines.positions_mm.size(), false) {
    merge_points(within_mm);
    gather_edges();
  }

  JoinedCentrelines join() {
    // First from where lines begin and none leads to: the mouths. Then what is left: lines that
    // run against each other.
    for (const bool mouths : {true, false}) {
      for (const std::uint32_t start : starts_) {
        if (state_[start] == unseen && (!mouths || !led_to_[start]) && !grow_from(start))
          return std::move(joined_);
      }
    }
    return std::move(joined_);
  }

private:
  static constexpr std::uint32_t unseen = no_parent;

  template <class Take> void for_each_line(Take take) const {
    std::uint64_t begin = 0;
    for (const std::uint64_t end : lines_.ends) {
      take(std::span{lines_.points}.subspan(begin, end - begin));
      begin = end;
    }
  }

  void merge_points(double within_mm) {
    PlaceFinder places{lines_.positions_mm, within_mm};
    for (const std::uint64_t point : lines_.points) {
      std::uint32_t& node = nodes_[point];
      if (node != no_parent)
        continue;
      node = places.find_or_add(static_cast<std::uint32_t>(point));
      joined_.merged_points += node != point ? 1U : 0U;
    }
    joined_.unused_points = static_cast<std::uint64_t>(std::ranges::count(nodes_, no_parent));
  }

  void gather_edges() {
    for_each_line([&](std::span<const std::uint64_t> line) {
      if (line.size() < 2) {
        ++joined_.short_lines;
        return;
      }
      starts_.push_back(nodes_[line.front()]);
      for (std::size_t i = 1; i < line.size(); ++i) {
        const std::uint32_t from = nodes_[line[i - 1]];
        const std::uint32_t to = nodes_[line[i]];
        if (from == to)
          continue;
        led_to_[to] = true;
        edges_.push_back({from, to});
        edges_.push_back({to, from});
      }
    });
    std::ranges::sort(edges_);
    edges_.erase(std::unique(edges_.begin(), edges_.end()), edges_.end());
    state_.assign(nodes_.size(), unseen);
  }

  std::span<const std::pair<std::uint32_t, std::uint32_t>> edges_of(std::uint32_t node) const {
    const auto first_of = [&](std::uint32_t wanted) {
      return std::ranges::lower_bound(edges_, wanted, {},
                                      [](const auto& edge) { return edge.first; });
    };
    return {first_of(node), first_of(node + 1)};
  }

  // False where a loop closes.
  bool grow_from(std::uint32_t root) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> open{{root, no_parent}}; // with its parent
    state_[root] = 0;
    while (!open.empty()) {
      const auto [node, parent] = open.back();
      open.pop_back();
      const auto place = static_cast<std::uint32_t>(joined_.tree.nodes());
      add_node(node, parent == no_parent ? no_parent : state_[parent]);
      state_[node] = place;
      const auto edges = edges_of(node);
      for (auto edge = edges.rbegin(); edge != edges.rend(); ++edge) {
        if (edge->second == parent)
          continue;
        if (state_[edge->second] != unseen) {
          tell_loop(edge->second);
          return false;
        }
        state_[edge->second] = 0; // seen; its place comes later
        open.push_back({edge->second, node});
      }
    }
    return true;
  }

  void add_node(std::uint32_t point, std::uint32_t parent) {
    VesselTree& tree = joined_.tree;
    const Place& p = lines_.positions_mm[point];
    tree.positions_mm.push_back(
        {static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])});
    tree.radii_mm.push_back(static_cast<float>(lines_.radii_mm[point]));
    tree.parents.push_back(parent);
    tree.branches.push_back(VesselBranch::unknown);
  }

  void tell_loop(std::uint32_t point) {
    const Place& p = lines_.positions_mm[point];
    joined_.loop = fmt::format("point {} at ({:g}, {:g}, {:g}) mm", point, p[0], p[1], p[2]);
    joined_.tree = {};
  }

  const Centrelines& lines_;
  std::vector<std::uint32_t> nodes_; // of each point: the point whose place it has
  std::vector<bool> led_to_;         // by a line, from somewhere
  std::vector<std::uint32_t> starts_;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges_; // both ways, sorted
  std::vector<std::uint32_t> state_;                           // unseen, else place in the tree
  JoinedCentrelines joined_;
};

} // namespace

JoinedCentrelines join_centrelines(const Centrelines& lines, double within_mm) {
  return Joiner{lines, within_mm}.join();
}

} // namespace octascope::pipeline
