#include "sim/coronary_tree/trunk_plan.h"

#include <algorithm>
#include <numeric>

#include "sim/coronary_tree/hash_random.h"

namespace octascope::sim {
namespace {

using Counts = std::array<std::size_t, pipeline::vessel_order_count>;

std::size_t whole(double value) {
  return static_cast<std::size_t>(value + 0.5);
}

// [mother][daughter]: how many elements of the daughter's order all mothers of an order have.
std::array<Counts, pipeline::vessel_order_count> joint_counts(const BranchMorphometry& branch) {
  std::array<Counts, pipeline::vessel_order_count> counts{};
  for (std::size_t daughter = 0; daughter < branch.highest_order; ++daughter) {
    const auto expected = [&](std::size_t mother) {
      return branch.daughters[daughter][mother] * branch.orders[mother].elements.mean;
    };
    double all = 0;
    for (std::size_t m = lowest_trunk_order; m <= branch.highest_order; ++m)
      all += expected(m);
    double wanted = all;
    if (daughter + 1 == lowest_trunk_order)
      wanted = branch.orders[daughter].elements.mean * (1 - branch.daughters[daughter][daughter]);
    else if (daughter >= lowest_trunk_order)
      wanted = branch.orders[daughter].elements.mean;
    // Rounded so that the sum is right: each gets what the running sum has grown by.
    double running = 0;
    for (std::size_t m = branch.highest_order + 1; m-- > lowest_trunk_order;) {
      const std::size_t before = whole(running);
      running += all > 0 ? expected(m) * wanted / all : 0;
      counts[m][daughter] = whole(running) - before;
    }
  }
  return counts;
}

// Segments of so many elements: their mean as published, as far as so many daughters allow. A
// segment ends where something springs off, the last one where at least two do.
std::vector<std::uint32_t> segment_counts(const OrderMorphometry& order, std::size_t elements,
                                          std::size_t daughters, HashRandom& draws) {
  std::vector<std::uint32_t> counts(elements);
  std::size_t sum = 0;
  for (std::uint32_t& count : counts) {
    const double drawn = draws.positive(order.segments_per_element);
    count = static_cast<std::uint32_t>(std::max<std::size_t>(1, draws.rounded(drawn)));
    sum += count;
  }
  const std::size_t most = std::max(elements, daughters - std::min(daughters, elements));
  const std::size_t wanted =
      std::min(whole(order.segments_per_element.mean * static_cast<double>(elements)), most);
  while (sum != wanted) {
    std::uint32_t& count = counts[draws.below(elements)];
    if (sum < wanted) {
      ++count;
      ++sum;
    } else if (count > 1) {
      --count;
      --sum;
    }
  }
  return counts;
}

class Dealer {
public:
  Dealer(const BranchMorphometry& branch, std::uint64_t key) : branch_{branch}, draws_{key} {
    PlannedElement root;
    root.order = branch.highest_order;
    root.on_course = true;
    plan_.elements.push_back(root);
  }

  TrunkPlan deal() {
    const auto counts = joint_counts(branch_);
    for (std::size_t order = branch_.highest_order; order >= lowest_trunk_order; --order)
      deal_order(order, counts[order]);
    return std::move(plan_);
  }

private:
  using Hand = std::vector<std::size_t>; // orders of an element's daughters

  void deal_order(std::size_t order, const Counts& counts) {
    std::vector<std::uint32_t> mothers = elements_of(order);
    const std::size_t founders = mothers.size();
    const std::size_t elements = founders + counts[order];
    const std::size_t daughters = std::accumulate(counts.begin(), counts.end(), std::size_t{0});
    const auto segments = segment_counts(branch_.orders[order], elements, daughters, draws_);
    std::vector<Hand> hands = hands_of(order, counts, segments, founders);
    for (std::size_t i = 0; i < hands.size(); ++i) {
      plan_.elements[mothers[i]].segments = segments[i];
      add_daughters(mothers[i], hands[i], mothers);
    }
  }

  std::vector<std::uint32_t> elements_of(std::size_t order) {
    std::vector<std::uint32_t> found;
    for (std::size_t i = 0; i < plan_.elements.size(); ++i)
      if (plan_.elements[i].order == order)
        found.push_back(static_cast<std::uint32_t>(i));
    return found;
  }

  // Daughters of their mother's own order go to elements that are there already, and that have a
  // side: at an element's end they would be the element itself.
  std::vector<Hand> hands_of(std::size_t order, const Counts& counts,
                             std::span<const std::uint32_t> segments, std::size_t founders) {
    std::vector<Hand> hands(segments.size());
    for (std::size_t i = 0; i < counts[order]; ++i) {
      std::size_t mother = draws_.below(founders);
      for (std::size_t tries = 0; segments[mother] < 2 && tries < 4 * founders; ++tries)
        mother = draws_.below(founders);
      hands[mother].push_back(order);
    }
    Hand pool;
    for (std::size_t daughter = 0; daughter < order; ++daughter)
      pool.insert(pool.end(), counts[daughter], daughter);
    draws_.shuffle(std::span{pool});
    for (std::size_t i = 0; i < hands.size(); ++i)
      while (hands[i].size() < segments[i] + 1 && !pool.empty()) {
        hands[i].push_back(pool.back());
        pool.pop_back();
      }
    for (const std::size_t left : pool)
      hands[draws_.below(hands.size())].push_back(left);
    return hands;
  }

  // The largest goes on where the element ends, with any other; the rest spring from its side.
  void add_daughters(std::uint32_t mother, Hand& hand, std::vector<std::uint32_t>& same_order) {
    const std::size_t order = plan_.elements[mother].order;
    const std::uint32_t segments = plan_.elements[mother].segments;
    if (hand.empty())
      return;
    draws_.shuffle(std::span{hand});
    const auto size_below = [order](std::size_t daughter) {
      return daughter == order ? std::size_t{0} : daughter + 1;
    };
    std::iter_swap(hand.begin(), std::ranges::max_element(hand, [&](std::size_t a, std::size_t b) {
                     return size_below(a) < size_below(b);
                   }));
    // Where it ends, none of its own order: that would be the element itself.
    std::stable_partition(hand.begin() + 1, hand.end(),
                          [order](std::size_t daughter) { return daughter != order; });
    plan_.elements[mother].first_daughter = static_cast<std::uint32_t>(plan_.elements.size());
    plan_.elements[mother].daughters = static_cast<std::uint32_t>(hand.size());
    for (std::size_t i = 0; i < hand.size(); ++i) {
      PlannedElement daughter;
      daughter.order = hand[i];
      daughter.mother = mother;
      daughter.joint = segments - 1;
      if (i >= 2)
        daughter.joint =
            static_cast<std::uint32_t>(i - 1 < segments ? i - 2 : draws_.below(segments));
      daughter.on_course =
          plan_.elements[mother].on_course && i == 0 && daughter.order >= lowest_outer_order;
      if (daughter.order == order)
        same_order.push_back(static_cast<std::uint32_t>(plan_.elements.size()));
      plan_.elements.push_back(daughter);
    }
  }

  const BranchMorphometry& branch_;
  HashRandom draws_;
  TrunkPlan plan_;
};

} // namespace

TrunkPlan plan_trunk(const BranchMorphometry& branch,
                     const std::array<double, lowest_trunk_order>& weights, std::uint64_t key) {
  TrunkPlan plan = Dealer{branch, key}.deal();
  for (std::size_t i = plan.elements.size(); i-- > 0;) {
    PlannedElement& element = plan.elements[i];
    if (!element.is_trunk())
      element.weight = weights[element.order];
    if (i > 0)
      plan.elements[element.mother].weight += element.weight;
  }
  return plan;
}

} // namespace octascope::sim
