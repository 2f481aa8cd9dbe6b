// Rules shared by large and small vessels at each fork: diameters, lengths and angles.
#pragma once

#include "sim/coronary_tree/hash_random.h"
#include "sim/coronary_tree/heart/vector3.h"
#include "sim/coronary_tree/morphometry.h"

namespace octascope::sim {

// The diameters of an element's segments, from the first to the last.
class Calibre {
public:
  // No wider than the mother.
  Calibre(const BranchMorphometry& branch, std::size_t order, std::size_t segments,
          double mother_um, HashRandom& draws);

  double diameter_um(std::size_t segment) const;

private:
  double mean_um_;
  double first_um_; // more than the mean
  double step_um_;  // less at each fork
  double least_um_;
  double most_um_;
};

// A segment's length: of four drawn from the published distribution, the one nearest to the length
// needed. Most segments need more than the mean, so lengths come out about one deviation above it;
// shorter ones would not let the published number of vessels reach all of the muscle.
double segment_length_mm(const OrderMorphometry& order, double needed_mm, HashRandom& draws);

// The direction of a daughter heading for `target` (unit vectors): at about the angle to its mother
// that minimises the work of maintenance and perfusion (Murray, J Gen Physiol 9, 1926), which
// follows from the three diameters.
Vector3 daughter_direction(Vector3 mother, Vector3 target, double mother_um, double daughter_um,
                           double sister_um);

// Continues towards `target`, with at least this cosine to the old direction, winding a little.
Vector3 onward_direction(Vector3 direction, Vector3 target, double least_cosine, double winding,
                         HashRandom& draws);

} // namespace octascope::sim
