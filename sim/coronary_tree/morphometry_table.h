// What a tree measures beside what was published.
#pragma once

#include <array>
#include <string>

#include "pipeline/vessels/tree.h"
#include "sim/coronary_tree/coronary_tree.h"
#include "sim/coronary_tree/morphometry.h"

namespace octascope::sim {

// One number of one order of one branch. z is the achieved mean's distance from the published one
// in published standard deviations; for numbers of elements the published number times the declared
// factor is expected, and z is in published standard errors (times that factor). Where none was
// published z is 0.
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
  Comparison elements; // of order 0: published daughters times published mothers
};

struct MorphometryTable {
  std::array<std::array<OrderComparison, pipeline::vessel_order_count>, 3> branches;
  double growth = 1;       // of daughters of an element of the orders 1 to 4
  double whole_factor = 1; // segments relative to a tree by the published numbers
  double murray_ratio = 0; // mean of Σ daughters' D³ / mother's D³, mothers below 50 µm
};

// Measures the tree alone: elements are runs of segments of one order; where two daughters have
// their mother's order, the wider one goes on.
MorphometryTable compare_with_published(const CoronaryTree& coronary);

// Of a tree from elsewhere: its factors are measured as well. Of the lowest order that
// is there, the elements relative to the published number in all three branches; of those above it
// measured_growth()'s.
MorphometryTable compare_with_published(const pipeline::VesselTree& tree);

std::string to_text(const MorphometryTable& table);

} // namespace octascope::sim
