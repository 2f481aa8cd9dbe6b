// A tree's measurements beside the published ones.
#pragma once

#include <array>
#include <string>

#include "pipeline/vessels/tree.h"
#include "sim/coronary_tree/coronary_tree.h"
#include "sim/coronary_tree/morphometry.h"

namespace octascope::sim {

// One quantity of one order of one branch. z is the deviation of the achieved mean from the
// published one in published standard deviations; for numbers of elements, from the published
// number times the declared factor, in published standard errors times that factor. z is 0 if
// nothing was published.
struct Comparison {
  double achieved = 0;
  double achieved_deviation = 0; // 0 for numbers of elements
  double published = 0;
  double published_deviation = 0;
  double z = 0;
};

struct OrderComparison {
  bool present = false;
  double factor = 1; // declared: expected elements relative to the published number
  std::size_t segments = 0;
  Comparison diameter_um;
  Comparison length_mm;
  Comparison segments_per_element;
  Comparison elements; // of order 0: published daughters times published mothers
};

struct MorphometryTable {
  std::array<std::array<OrderComparison, pipeline::vessel_order_count>, 3> branches;
  double growth = 1;       // factor on the daughters of elements of orders 1 to 4
  double whole_factor = 1; // segments relative to a tree with the published numbers
  double murray_ratio = 0; // mean of Σ daughters' D³ / mother's D³, mothers below 50 µm
};

// Measures the tree alone: elements are runs of segments of one order; where two daughters have
// their mother's order, the wider one continues the element.
MorphometryTable compare_with_published(const CoronaryTree& coronary);

// For a tree from elsewhere, whose factors are measured as well: for the lowest order present, its
// elements relative to the published number over all three branches; above it, measured_growth()'s.
MorphometryTable compare_with_published(const pipeline::VesselTree& tree);

std::string to_text(const MorphometryTable& table);

} // namespace octascope::sim
