#include "pipeline/vessels/vessel_orders.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "pipeline/vessels/stoppable.h"

namespace octascope::pipeline {
namespace {

// Of the node's vessel, 0 at the tips; without a limit (a tree of 2³² nodes ends at 32).
std::vector<std::uint8_t> strahler_orders(const VesselTree& tree) {
  std::vector<std::uint8_t> orders(tree.nodes(), 0);
  std::vector<std::uint8_t> meets(tree.nodes(), 0); // children of that order, up to 2
  for (std::size_t i = tree.nodes(); i-- > 0;) {
    if (meets[i] > 1)
      ++orders[i];
    const std::uint32_t parent = tree.parents[i];
    if (parent == no_parent)
      continue;
    if (meets[parent] == 0 || orders[i] > orders[parent]) {
      orders[parent] = orders[i];
      meets[parent] = 1;
    } else if (orders[i] == orders[parent]) {
      meets[parent] = 2;
    }
  }
  return orders;
}

// Vessels as stretches of nodes between branchings.
struct Vessels {
  std::vector<std::uint32_t> of_node; // no_parent for roots
  std::vector<float> radii;           // mean
  std::vector<std::uint8_t> orders;
};

Vessels find_vessels(const VesselTree& tree, const std::vector<std::uint8_t>& node_orders) {
  std::vector<std::uint8_t> children(tree.nodes(), 0); // up to 2
  for (const std::uint32_t parent : tree.parents) {
    if (parent != no_parent && children[parent] < 2)
      ++children[parent];
  }
  Vessels vessels;
  vessels.of_node.assign(tree.nodes(), no_parent);
  std::vector<double> sums;
  std::vector<std::uint32_t> counts;
  for (std::size_t i = 0; i < tree.nodes(); ++i) {
    const std::uint32_t parent = tree.parents[i];
    if (parent == no_parent)
      continue;
    const bool goes_on = children[parent] == 1 && tree.parents[parent] != no_parent;
    if (goes_on) {
      vessels.of_node[i] = vessels.of_node[parent];
    } else {
      vessels.of_node[i] = static_cast<std::uint32_t>(sums.size());
      sums.push_back(0);
      counts.push_back(0);
      vessels.orders.push_back(node_orders[i]);
    }
    sums[vessels.of_node[i]] += static_cast<double>(tree.radii_mm[i]);
    ++counts[vessels.of_node[i]];
  }
  vessels.radii.reserve(sums.size());
  for (std::size_t i = 0; i < sums.size(); ++i)
    vessels.radii.push_back(static_cast<float>(sums[i] / counts[i]));
  return vessels;
}

void limit_from_the_top(std::vector<std::uint8_t>& orders) {
  if (orders.empty())
    return;
  const int above = *std::ranges::max_element(orders) - highest_vessel_order;
  for (std::uint8_t& order : orders)
    order = static_cast<std::uint8_t>(std::max(0, order - std::max(0, above)));
}

// Count, sum and sum of squares: mean and deviation of a class of vessels.
struct Class {
  double count = 0;
  double sum = 0;
  double squares = 0;

  void add(const Class& other) {
    count += other.count;
    sum += other.sum;
    squares += other.squares;
  }
  double mean() const { return sum / count; }
  double deviation() const { return std::sqrt(std::max(0.0, squares / count - mean() * mean())); }
};

// Leaves out empty classes and makes one of neighbours whose means do not rise.
void tidy(std::vector<Class>& classes) {
  std::vector<Class> risen;
  risen.reserve(classes.size());
  for (const Class& next : classes) {
    if (next.count == 0)
      continue;
    risen.push_back(next);
    while (risen.size() > 1 && risen.back().mean() <= risen[risen.size() - 2].mean()) {
      risen[risen.size() - 2].add(risen.back());
      risen.pop_back();
    }
  }
  classes = std::move(risen);
}

double border(const Class& low, const Class& high) {
  const double middle = ((low.mean() + low.deviation()) + (high.mean() - high.deviation())) / 2;
  return std::clamp(middle, low.mean(), high.mean());
}

// Radii in order with sums up to each piece of them, so that a class of all between two borders
// costs two searches.
class SortedRadii {
public:
  SortedRadii(std::vector<float> radii, const std::stop_token& stop) : radii_{std::move(radii)} {
    stoppable_sort(radii_, std::less<>{}, stop);
    if (stop.stop_requested())
      return;
    sums_.resize(radii_.size() / piece + 1);
    for (std::size_t i = 1; i < sums_.size(); ++i) {
      sums_[i] = sums_[i - 1];
      add(sums_[i], (i - 1) * piece, i * piece);
    }
  }

  bool all_equal() const { return radii_.empty() || radii_.front() == radii_.back(); }

  std::vector<Class> between(const std::vector<double>& borders) const {
    std::vector<Class> classes;
    classes.reserve(borders.size() + 1);
    Class from;
    const auto close = [&](std::size_t end) {
      const Class to = sum_up_to(end);
      classes.push_back({to.count - from.count, to.sum - from.sum, to.squares - from.squares});
      from = to;
    };
    for (const double radius : borders)
      close(static_cast<std::size_t>(std::ranges::upper_bound(radii_, radius) - radii_.begin()));
    close(radii_.size());
    return classes;
  }

private:
  static constexpr std::size_t piece = 256;

  void add(Class& sum, std::size_t from, std::size_t to) const {
    for (std::size_t i = from; i < to; ++i) {
      const double radius{radii_[i]};
      sum.add({1, radius, radius * radius});
    }
  }
  Class sum_up_to(std::size_t end) const {
    Class sum = sums_[end / piece];
    add(sum, end / piece * piece, end);
    return sum;
  }

  std::vector<float> radii_;
  std::vector<Class> sums_; // of all before each piece
};

std::vector<Class> classes_of(const Vessels& vessels) {
  std::vector<Class> classes(vessel_order_count);
  for (std::size_t i = 0; i < vessels.radii.size(); ++i) {
    const double radius{vessels.radii[i]};
    classes[vessels.orders[i]].add({1, radius, radius * radius});
  }
  return classes;
}

bool settled(const std::vector<Class>& before, const std::vector<Class>& after) {
  return std::ranges::equal(before, after, [&](const Class& a, const Class& b) {
    const double tolerance = 0.01 * b.mean(); // the paper's
    return std::fabs(a.mean() - b.mean()) <= tolerance &&
           std::fabs(a.deviation() - b.deviation()) <= tolerance;
  });
}

// The borders between orders, as radii; none where diameters do not tell orders apart.
std::vector<double> find_borders(std::vector<Class> classes, const SortedRadii& radii) {
  std::vector<double> borders;
  constexpr int most_rounds = 100; // the paper needed two or three
  for (int round = 0; round < most_rounds; ++round) {
    tidy(classes);
    borders.clear();
    for (std::size_t i = 0; i + 1 < classes.size(); ++i)
      borders.push_back(border(classes[i], classes[i + 1]));
    std::vector<Class> next = radii.between(borders);
    const bool whole = std::ranges::none_of(next, [](const Class& c) { return c.count == 0; });
    if (whole && settled(classes, next))
      break;
    classes = std::move(next);
  }
  return borders;
}

} // namespace

OrderRule assign_vessel_orders(VesselTree& tree, const std::stop_token& stop) {
  const std::vector<std::uint8_t> strahler = strahler_orders(tree);
  if (stop.stop_requested())
    return OrderRule::strahler;
  Vessels vessels = find_vessels(tree, strahler);
  limit_from_the_top(vessels.orders);
  const SortedRadii radii{vessels.radii, stop};
  if (stop.stop_requested())
    return OrderRule::strahler;
  const std::vector<double> borders =
      radii.all_equal() ? std::vector<double>{} : find_borders(classes_of(vessels), radii);
  for (std::size_t i = 0; i < vessels.orders.size() && !borders.empty(); ++i)
    vessels.orders[i] = static_cast<std::uint8_t>(
        std::ranges::lower_bound(borders, double{vessels.radii[i]}) - borders.begin());
  tree.orders.assign(tree.nodes(), 0);
  for (std::size_t i = tree.nodes(); i-- > 0;) {
    if (tree.parents[i] == no_parent)
      continue;
    tree.orders[i] = vessels.orders[vessels.of_node[i]];
    if (tree.parents[tree.parents[i]] == no_parent) {
      std::uint8_t& root = tree.orders[tree.parents[i]];
      root = std::max(root, tree.orders[i]);
    }
  }
  return borders.empty() ? OrderRule::strahler : OrderRule::diameter;
}

} // namespace octascope::pipeline
