#include "sim/coronary_tree/spacing/relaxation.h"

#include <algorithm>
#include <cmath>

#include "sim/coronary_tree/spacing/in_chunks.h"
#include "sim/coronary_tree/spacing/segment_grid.h"
#include "sim/coronary_tree/spacing/segments.h"
#include "sim/coronary_tree/spacing/tree_shape.h"

namespace octascope::sim {
namespace {

// Two segments that may come to run through each other.
struct Pair {
  std::uint32_t a;
  std::uint32_t b;
};

// Moves a segment's start and end.
struct Push {
  std::uint32_t segment;
  Vector3 start_mm;
  Vector3 end_mm;
};

class Relaxer {
public:
  Relaxer(pipeline::VesselTree& tree, const std::vector<bool>& still, const Relaxation& how,
          const std::function<Vector3(Vector3, std::size_t)>& hold)
      : tree_{tree}, still_{still}, threads_{how.threads},
        farthest_radii_{how.farthest_radii}, hold_{hold}, next_{widest_daughters(tree)},
        moves_(tree.nodes()), pairs_(chunks_of(tree.nodes())), pushes_(chunks_of(tree.nodes())),
        least_mm_(tree.nodes()) {
    constexpr double of_now = 0.5;
    for (std::uint32_t i = 0; i < tree.nodes(); ++i)
      if (tree.parents[i] != pipeline::no_parent)
        least_mm_[i] = static_cast<float>(of_now * length_mm(i));
  }

  // Those that may meet before they are searched for again.
  void find_pairs() {
    const SegmentGrid grid{tree_, static_cast<float>(close)};
    in_chunks(tree_.nodes(), threads_, [&](std::size_t chunk, std::size_t first, std::size_t end) {
      pairs_[chunk].clear();
      std::vector<std::uint32_t> near;
      for (auto i = static_cast<std::uint32_t>(first); i < end; ++i) {
        if (tree_.parents[i] == pipeline::no_parent)
          continue;
        grid.find_near(tree_, i, near);
        for (const std::uint32_t other : near)
          if (are_close(i, other))
            pairs_[chunk].push_back({i, other});
      }
    });
  }

  void round(bool unbend) {
    in_chunks(tree_.nodes(), threads_, [&](std::size_t chunk, std::size_t first, std::size_t end) {
      pushes_[chunk].clear();
      for (const Pair& pair : pairs_[chunk])
        push_apart(pair, pushes_[chunk]);
      for (std::size_t i = first; i < end; ++i)
        moves_[i] = lengthening(static_cast<std::uint32_t>(i)) +
                    (unbend ? straighter(static_cast<std::uint32_t>(i)) : Vector3{});
    });
    // In the order of the chunks: sums depend on their order.
    for (const std::vector<Push>& chunk : pushes_)
      for (const Push& push : chunk) {
        Vector3& start = moves_[tree_.parents[push.segment]];
        start = start + push.start_mm;
        moves_[push.segment] = moves_[push.segment] + push.end_mm;
      }
    in_chunks(tree_.nodes(), threads_, [&](std::size_t, std::size_t first, std::size_t end) {
      for (std::size_t i = first; i < end; ++i)
        move(static_cast<std::uint32_t>(i));
    });
  }

private:
  static constexpr double close = 2; // times both radii
  static constexpr double clear = 1.05;
  static constexpr double most_of_least = 4; // lengths: from half to twice of what they were
  static constexpr double near_along = 2.5;  // there a fork's daughters may touch

  bool is_still(std::uint32_t node) const {
    return still_[node] || tree_.parents[node] == pipeline::no_parent;
  }

  double radius_mm(std::uint32_t node) const { return static_cast<double>(tree_.radii_mm[node]); }

  bool are_close(std::uint32_t a, std::uint32_t b) const {
    if (is_still(a) && is_still(b))
      return false;
    const double both = radius_mm(a) + radius_mm(b);
    const Vector3 apart = nearest_approach(segment_line(tree_, a), segment_line(tree_, b)).apart;
    return dot(apart, apart) < close * close * both * both &&
           !near_along_tree(tree_, a, b, near_along * both);
  }

  void push_apart(const Pair& pair, std::vector<Push>& pushes) const {
    const double both = radius_mm(pair.a) + radius_mm(pair.b);
    const Line a = segment_line(tree_, pair.a);
    const Line b = segment_line(tree_, pair.b);
    const Approach nearest = nearest_approach(a, b);
    const double distance = length(nearest.apart);
    if (distance >= both)
      return;
    const Vector3 away = distance > 0.01 * both
                             ? (1 / distance) * nearest.apart
                             : unit(cross(a.to - a.from, b.to - b.from), {1, 0, 0});
    // Each gives way in proportion to the other's cross-section.
    const double weight_a = radius_mm(pair.a) * radius_mm(pair.a);
    const double weight_b = radius_mm(pair.b) * radius_mm(pair.b);
    double part_of_a = weight_b / (weight_a + weight_b);
    if (is_still(pair.a) || is_still(pair.b))
      part_of_a = is_still(pair.a) ? 0 : 1;
    const Vector3 by = (clear * both - distance) * away;
    push(pair.a, nearest.a, part_of_a * by, pushes);
    push(pair.b, nearest.b, (part_of_a - 1) * by, pushes);
  }

  // Moves its two nodes so that the place at `along` moves by that much; where the start keeps still, a
  // place near it hardly moves, or the end would be thrown far out.
  void push(std::uint32_t segment, double along, Vector3 by, std::vector<Push>& pushes) const {
    constexpr double least = 0.3;
    if (is_still(segment))
      return;
    if (is_still(tree_.parents[segment])) {
      pushes.push_back({segment, {}, (along / std::max(along * along, least * least)) * by});
      return;
    }
    const double scale = 1 / (along * along + (1 - along) * (1 - along));
    pushes.push_back({segment, scale * (1 - along) * by, scale * along * by});
  }

  double length_mm(std::uint32_t segment) const {
    const Line line = segment_line(tree_, segment);
    return length(line.to - line.from);
  }

  // Of its end, so that a hairpin is not straightened to nothing, and none becomes a spike.
  Vector3 lengthening(std::uint32_t segment) const {
    if (is_still(segment))
      return {};
    const double now = length_mm(segment);
    const auto least = static_cast<double>(least_mm_[segment]);
    const double wanted = std::clamp(now, least, most_of_least * least);
    if (wanted == now)
      return {};
    const Line line = segment_line(tree_, segment);
    return (wanted - now) * unit(line.to - line.from, {1, 0, 0});
  }

  // Where a vessel bends too sharply, towards the line between the neighbours; the end of a segment that leaves a node that keeps still, towards where it would go on to.
  Vector3 straighter(std::uint32_t node) const {
    if (is_still(node))
      return {};
    const std::uint32_t parent = tree_.parents[node];
    Vector3 by;
    if (next_[node] != pipeline::no_parent)
      by = unbent(parent, node, next_[node]);
    if (is_still(parent) && next_[parent] == node && tree_.parents[parent] != pipeline::no_parent) {
      const Vector3 back = unbent(tree_.parents[parent], parent, node);
      const double before = length_mm(parent);
      const double after = length_mm(node);
      by = by - ((before + after) / std::max(before, after)) * back;
    }
    return by;
  }

  Vector3 unbent(std::uint32_t from, std::uint32_t node, std::uint32_t to) const {
    constexpr double gentle = 0.034; // 1 − the cosine of 15 degrees
    constexpr double share = 0.5;
    const Vector3 in = node_place(tree_, node) - node_place(tree_, from);
    const Vector3 out = node_place(tree_, to) - node_place(tree_, node);
    const double before = length(in);
    const double after = length(out);
    if (before < 1e-6 || after < 1e-6)
      return {};
    const double bend = 1 - dot(in, out) / (before * after);
    if (bend <= gentle)
      return {};
    return (share * (1 - std::sqrt(gentle / bend)) / (before + after)) *
           (before * out - after * in);
  }

  // Many pushes add up where vessels are dense.
  void move(std::uint32_t node) {
    const double far = length(moves_[node]);
    if (is_still(node) || far == 0)
      return;
    const double most = static_cast<double>(least_mm_[node]) + farthest_radii_ * radius_mm(node);
    const Vector3 by = std::min(1.0, most / far) * moves_[node];
    const Vector3 place = hold_(node_place(tree_, node) + by, tree_.orders[node]);
    tree_.positions_mm[node] = {static_cast<float>(place.x), static_cast<float>(place.y),
                                static_cast<float>(place.z)};
  }

  pipeline::VesselTree& tree_;
  const std::vector<bool>& still_;
  std::size_t threads_;
  double farthest_radii_;
  const std::function<Vector3(Vector3, std::size_t)>& hold_;
  std::vector<std::uint32_t> next_;
  std::vector<Vector3> moves_;
  std::vector<std::vector<Pair>> pairs_; // by the chunk of the one that found the other
  std::vector<std::vector<Push>> pushes_;
  std::vector<float> least_mm_; // the length of each segment
};

} // namespace

void relax(pipeline::VesselTree& tree, const std::vector<bool>& still, const Relaxation& how,
           const std::function<Vector3(Vector3, std::size_t)>& hold,
           const std::function<void(double)>& progress) {
  constexpr std::size_t rounds_a_search = 4;
  Relaxer relaxer{tree, still, how, hold};
  for (std::size_t i = 0; i < how.rounds; ++i) {
    if (i % rounds_a_search == 0)
      relaxer.find_pairs();
    relaxer.round(i < how.unbending_rounds);
    if (progress)
      progress(static_cast<double>(i + 1) / static_cast<double>(how.rounds));
  }
}

} // namespace octascope::sim
