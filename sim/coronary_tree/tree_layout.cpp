#include "sim/coronary_tree/tree_layout.h"

#include <algorithm>
#include <tuple>

#include "sim/coronary_tree/hash_random.h"

namespace octascope::sim {
namespace {

class Layouter {
public:
  Layouter(const std::array<TrunkPlan, 3>& plans, std::uint64_t key) : plans_{plans}, key_{key} {
    for (std::size_t b = 0; b < 3; ++b)
      layout_.branches[b].resize(plans[b].elements.size());
  }

  TreeLayout lay_out(std::uint32_t segments) {
    const std::uint32_t left = keep_trunk(segments);
    if (left > 0 && layout_.lowest_trunk_order == lowest_trunk_order)
      keep_twigs(left);
    number();
    return std::move(layout_);
  }

private:
  struct Candidate {
    std::uint64_t lot;
    std::size_t branch;
    std::uint32_t element;
  };

  std::uint64_t lot(std::size_t branch, std::uint32_t element) const {
    return hash(key_, branch, element);
  }

  LaidOutElement& laid_out(const Candidate& c) { return layout_.branches[c.branch][c.element]; }

  // By lot; but none before its mother, where that is of the same order.
  std::vector<Candidate> elements_of(std::size_t order) const {
    std::vector<Candidate> found;
    for (std::size_t b = 0; b < 3; ++b) {
      const auto& elements = plans_[b].elements;
      std::vector<std::uint64_t> lots(elements.size());
      for (std::uint32_t i = 0; i < elements.size(); ++i) {
        if (elements[i].order != order)
          continue;
        const std::uint32_t mother = elements[i].mother;
        lots[i] = lot(b, i);
        if (mother != i && elements[mother].order == order)
          lots[i] = std::max(lots[i], lots[mother] + 1);
        found.push_back({lots[i], b, i});
      }
    }
    std::ranges::sort(found, [](const Candidate& a, const Candidate& b) {
      return std::tie(a.lot, a.branch, a.element) < std::tie(b.lot, b.branch, b.element);
    });
    return found;
  }

  // From the highest order down, as far as the number goes. Returns what is left of it.
  std::uint32_t keep_trunk(std::uint32_t segments) {
    std::uint32_t left = segments;
    std::size_t order = pipeline::highest_vessel_order;
    for (; order >= lowest_trunk_order && left > 0; --order)
      for (const Candidate& c : elements_of(order)) {
        const std::uint32_t own = std::min(left, plans_[c.branch].elements[c.element].segments);
        laid_out(c).own = own;
        left -= own;
      }
    layout_.lowest_trunk_order = order + 1;
    return left;
  }

  std::vector<Candidate> beginnings() const {
    std::vector<Candidate> found;
    for (std::size_t b = 0; b < 3; ++b)
      for (std::uint32_t i = 0; i < plans_[b].elements.size(); ++i)
        if (!plans_[b].elements[i].is_trunk())
          found.push_back({lot(b, i), b, i});
    return found;
  }

  void keep_twigs(std::uint32_t segments) {
    const std::vector<Candidate> all = beginnings();
    std::array<std::array<std::size_t, lowest_trunk_order>, 3> counts{};
    for (const Candidate& c : all)
      ++counts[c.branch][plans_[c.branch].elements[c.element].order];
    layout_.low = fit_low_orders(counts, segments);
    std::array<CrownSizes, 3> sizes;
    for (std::size_t b = 0; b < 3; ++b)
      sizes[b] = crown_sizes(morphometry(coronary_branches[b]), layout_.low);
    std::vector<double> wanted;
    double sum = 0;
    for (const Candidate& c : all) {
      const std::size_t order = plans_[c.branch].elements[c.element].order;
      const bool there =
          order != layout_.low.lowest_order || unit_interval(c.lot) < layout_.low.kept;
      wanted.push_back(there ? sizes[c.branch][order] : 0);
      sum += wanted.back();
    }
    share_out(all, wanted, sum, segments);
  }

  // Each gets what the running sum has grown by, so that the whole is exact.
  void share_out(const std::vector<Candidate>& all, const std::vector<double>& wanted, double sum,
                 std::uint32_t segments) {
    double running = 0;
    std::uint32_t given = 0;
    for (std::size_t i = 0; i < all.size(); ++i) {
      running += wanted[i];
      const std::uint32_t up_to = i + 1 == all.size()
                                      ? segments
                                      : static_cast<std::uint32_t>(running / sum * segments + 0.5);
      laid_out(all[i]).all = std::min(up_to, segments) - given;
      given = std::min(up_to, segments);
    }
  }

  void number() {
    for (std::size_t b = 0; b < 3; ++b) {
      auto& elements = layout_.branches[b];
      const auto& planned = plans_[b].elements;
      for (std::size_t i = elements.size(); i-- > 0;) {
        elements[i].all += elements[i].own;
        if (i > 0)
          elements[planned[i].mother].all += elements[i].all;
      }
      layout_.roots[b] = layout_.nodes;
      elements[0].node = layout_.nodes + 1;
      elements[0].parent = layout_.nodes;
      layout_.nodes += 1 + elements[0].all;
      for (std::size_t i = 0; i < elements.size(); ++i)
        if (planned[i].is_trunk())
          number_daughters(planned, elements, i);
    }
  }

  static void number_daughters(const std::vector<PlannedElement>& planned,
                               std::vector<LaidOutElement>& elements, std::size_t mother) {
    std::uint32_t node = elements[mother].node;
    for (std::uint32_t k = 0; k < elements[mother].own; ++k) {
      const std::uint32_t joint = node++;
      for (std::uint32_t i = 0; i < planned[mother].daughters; ++i) {
        const std::uint32_t daughter = planned[mother].first_daughter + i;
        if (planned[daughter].joint != k)
          continue;
        elements[daughter].node = node;
        elements[daughter].parent = joint;
        node += elements[daughter].all;
      }
    }
  }

  const std::array<TrunkPlan, 3>& plans_;
  std::uint64_t key_;
  TreeLayout layout_;
};

} // namespace

TreeLayout lay_out(const std::array<TrunkPlan, 3>& plans, std::uint32_t segments,
                   std::uint64_t key) {
  return Layouter{plans, key}.lay_out(segments);
}

} // namespace octascope::sim
