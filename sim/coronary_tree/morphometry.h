// Measurements of casts of pig hearts: how many vessels of which size, and how they join.
//
// Kassab, Rider, Tang, Fung: Morphometry of pig coronary arterial trees, Am J Physiol 265 (1993),
// H350–H365, tables 1–3 (segments), 5 (segments per element), 6–8 (connectivity), 9 (totals). A
// segment lies between two forks; an element is a run of segments of one order. Orders 1 to 3 of
// LAD and LCX were measured together.
//
// Not in those tables, and assumed here: order 0, the first segment of a capillary, has a diameter
// of 6.2 ± 1.1 µm, a length of 52 ± 32 µm, and one segment an element.
#pragma once

#include <array>
#include <cstddef>

#include "pipeline/vessels/tree.h"

namespace octascope::sim {

struct MeanAndDeviation {
  double mean = 0;
  double deviation = 0; // standard deviation; 0: single observation
};

// One order of one branch. elements.deviation is a standard error.
struct OrderMorphometry {
  MeanAndDeviation diameter_um;
  MeanAndDeviation length_mm;
  MeanAndDeviation segments_per_element;
  MeanAndDeviation elements;
  double element_diameter_deviation_um = 0;
};

struct BranchMorphometry {
  std::array<OrderMorphometry, pipeline::vessel_order_count> orders;
  // [daughter][mother]: mean number of elements of the daughter's order springing from an element
  // of the mother's.
  std::array<std::array<double, pipeline::vessel_order_count>, pipeline::vessel_order_count>
      daughters;
  std::size_t highest_order = 0;

  // All daughters of an element.
  double daughters_of(std::size_t mother) const;
};

inline constexpr std::array<pipeline::VesselBranch, 3> coronary_branches{
    pipeline::VesselBranch::rca, pipeline::VesselBranch::lad, pipeline::VesselBranch::lcx};

const BranchMorphometry& morphometry(pipeline::VesselBranch branch);

// The range of diameters of an order (ibid., equations 1a and 1b): bounded halfway between one
// order's mean plus deviation and the next one's mean minus deviation.
struct DiameterRange {
  double least_um;
  double most_um;
};
DiameterRange diameter_range(const BranchMorphometry& branch, std::size_t order);

// Mean ratio of the larger daughter's diameter to the mother's, by the mother's order: Kaimovitz,
// Huo, Lanir, Kassab, Am J Physiol 294 (2008), H714–H723.
double large_daughter_ratio(std::size_t mother_order);

} // namespace octascope::sim
