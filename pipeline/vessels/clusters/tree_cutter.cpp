#include "pipeline/vessels/clusters/tree_cutter.h"

#include <algorithm>
#include <array>
#include <tuple>

#include "pipeline/vessels/stoppable.h"

namespace octascope::pipeline {
namespace {

// Bounds between orders, by which thick vessels and thin ones are told apart.
//
// A joint that is cut costs two references. So the lowest bound is where the cut joints are at
// most one in a hundred segments (order 5, in a coronary tree), and each further one where they are
// few beside those of the last.
class OrderBands {
public:
  explicit OrderBands(const VesselTree& tree) {
    std::array<std::uint64_t, vessel_order_count> cut{};
    for (std::size_t i = 0; i < tree.nodes(); ++i) {
      const std::uint32_t parent = tree.parents[i];
      if (parent == no_parent || tree.parents[parent] == no_parent)
        continue;
      const auto [low, high] = std::minmax(tree.orders[i], tree.orders[parent]);
      for (std::size_t bound = low + 1U; bound <= high; ++bound)
        ++cut[bound];
    }
    std::uint64_t most = tree.nodes() / 100;
    for (std::size_t order = 1; order < cut.size(); ++order) {
      const bool bound = cut[order] > 0 && cut[order] <= most;
      if (bound)
        most = cut[order] / 16;
      bands_[order] = bands_[order - 1] + (bound ? 1U : 0U);
    }
  }

  std::uint32_t operator[](std::uint8_t order) const { return bands_[order]; }

private:
  std::array<std::uint32_t, vessel_order_count> bands_{};
};

class Cutter {
public:
  explicit Cutter(const VesselTree& tree) : tree_{tree}, bands_{tree} {
    cut_.piece_of.assign(tree.nodes(), no_parent);
  }

  // A node after all that hangs on it.
  void visit(std::uint32_t node) {
    std::size_t first = open_.size();
    while (first > 0 && open_[first - 1].piece.parent == node)
      --first;
    const std::span<Branch> children = std::span{open_}.subspan(first);
    if (tree_.parents[node] == no_parent) {
      close_all(children);
      open_.resize(first);
      return;
    }
    Branch own = segment(node);
    const std::size_t joined = join(own, children);
    close_all(children.subspan(joined));
    open_.resize(first);
    open_.push_back(own);
  }

  TreePieces finish() { return std::move(cut_); }

private:
  // A piece that may still grow, with the segment at its upper end.
  struct Branch {
    TreePiece piece;
    std::uint32_t top;
  };

  static constexpr std::size_t many = 8; // children

  Branch segment(std::uint32_t node) const {
    Branch branch;
    branch.top = node;
    TreePiece& piece = branch.piece;
    piece.parent = tree_.parents[node];
    const auto& a = tree_.positions_mm[node];
    const auto& b = tree_.positions_mm[piece.parent];
    piece.box.include(a);
    piece.box.include(b);
    piece.thinnest_mm = tree_.radii_mm[node];
    piece.shortest_mm = std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
    piece.segments = 1;
    piece.kind = static_cast<std::uint32_t>(tree_.branches[node]) | bands_[tree_.orders[node]] << 8;
    return branch;
  }

  static bool can_join(const TreePiece& piece, const TreePiece& other) {
    if (piece.kind != other.kind || piece.segments + other.segments > largest_piece)
      return false;
    TreePiece both = piece;
    both.join(other);
    return both.fine_enough();
  }

  // Which of its children's pieces the node's own segment takes along: the smallest, as many as
  // there is room for. They are the first of `children` afterwards; returns how many.
  static std::size_t join(Branch& own, std::span<Branch> children) {
    if (children.size() > many)
      return 0;
    std::ranges::sort(children, [](const Branch& a, const Branch& b) {
      return std::tie(a.piece.segments, a.top) < std::tie(b.piece.segments, b.top);
    });
    std::size_t joined = 0;
    for (Branch& child : children)
      if (can_join(own.piece, child.piece)) {
        own.piece.join(child.piece);
        std::swap(child, children[joined++]);
      }
    return joined;
  }

  // Those side by side, together where they can.
  void close_all(std::span<Branch> branches) {
    if (branches.size() > 1)
      sort_by_place(branches);
    for (std::size_t i = 0; i < branches.size();) {
      const auto number = static_cast<std::uint32_t>(cut_.pieces.size());
      TreePiece piece = branches[i].piece;
      cut_.piece_of[branches[i].top] = number;
      for (++i; i < branches.size() && can_join(piece, branches[i].piece); ++i) {
        piece.join(branches[i].piece);
        cut_.piece_of[branches[i].top] = number;
      }
      cut_.pieces.push_back(piece);
    }
  }

  void sort_by_place(std::span<Branch> branches) {
    TreeBox box;
    for (const Branch& branch : branches)
      box.include(branch.piece.box);
    places_.clear();
    for (const Branch& branch : branches)
      places_.push_back({branch.piece.kind, morton_code(box, branch.piece.box.middle()), branch});
    std::ranges::sort(places_, [](const Placed& a, const Placed& b) {
      return std::tie(a.kind, a.code, a.branch.top) < std::tie(b.kind, b.code, b.branch.top);
    });
    std::transform(places_.begin(), places_.end(), branches.begin(),
                   [](const Placed& placed) { return placed.branch; });
  }

  struct Placed {
    std::uint32_t kind;
    std::uint64_t code;
    Branch branch;
  };

  const VesselTree& tree_;
  OrderBands bands_;
  std::vector<Branch> open_; // of the nodes visited, those whose parent was not
  std::vector<Placed> places_;
  TreePieces cut_;
};

} // namespace

TreePieces cut_tree(const VesselTree& tree, std::span<const std::uint32_t> depth_first,
                    const std::stop_token& stop) {
  StopCheck stopped{stop};
  Cutter cutter{tree};
  for (std::size_t i = depth_first.size(); i-- > 0;) {
    cutter.visit(depth_first[i]);
    if (stopped())
      return {};
  }
  TreePieces cut = cutter.finish();
  // The cutter has named the pieces' uppermost segments; the others go with their parents.
  for (const std::uint32_t node : depth_first)
    if (cut.piece_of[node] == no_parent && tree.parents[node] != no_parent)
      cut.piece_of[node] = cut.piece_of[tree.parents[node]];
  return cut;
}

} // namespace octascope::pipeline
