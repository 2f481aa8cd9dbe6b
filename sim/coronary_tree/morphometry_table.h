// Compares a tree's morphometry with the published one.
#pragma once

#include <array>
#include <string>

#include "pipeline/vessels/tree.h"
#include "sim/coronary_tree/coronary_tree.h"
#include "sim/coronary_tree/morphometry.h"

namespace octascope::sim {

// One quantity of one order of one branch. z is the distance of the achieved mean from the
// published one, in published standard deviations. For numbers of elements, the published number
// times the declared factor is expected, and z is in published standard errors (times that factor).
// z is 0 if none was published.
struct Comparison {
  double achieved = 0;
  double achieved_deviation = 0; // 0 for numbers of elements
  double published = 0;
  double published_deviation = 0;
  double z = 0;
};

struct OrderComparison {
  bool present = false;
  double factor = 1; // declared: elements relative to the published number
  std::size_t segments = 0;
  Comparison diameter_um;
  Comparison length_mm;
  Comparison segments_per_element;
  Comparison elements; // for order 0: published daughters times published mothers
};

struct MorphometryTable {
  std::array<std::array<OrderComparison, pipeline::vessel_order_count>, 3> branches;
  double growth = 1;       // of daughters of an element of the orders 1 to 4
  double whole_factor = 1; // segments relative to a tree with the published numbers
  double murray_ratio = 0; // mean of Σ daughters' D³ / mother's D³, mothers below 50 µm
};

// Measures the tree alone. Elements are runs of segments of one order; where two daughters have
// their mother's order, the wider one continues the element.
MorphometryTable compare_with_published(const CoronaryTree& coronary);

// For a tree from elsewhere: also measures its factors. For the lowest order present, that is the
// number of elements relative to the published one, over all three branches; for higher orders it
// follows from measured_growth().
MorphometryTable compare_with_published(const pipeline::VesselTree& tree);

std::string to_text(const MorphometryTable& table);

} // namespace octascope::sim
