// What large and small vessels have in common at forks: diameters, lengths and angles.
#pragma once

#include "sim/coronary_tree/hash_random.h"
#include "sim/coronary_tree/heart/vector3.h"
#include "sim/coronary_tree/morphometry.h"

namespace octascope::sim {

// The diameters of an element's segments, from the first to the last.
class Calibre {
public:
  // Never wider than the mother. A large vessel of several segments tapers as published, or further,
  // as far as its order's range allows with the same mean: until its end is as narrow as `end_um`.
  Calibre(const BranchMorphometry& branch, std::size_t order, std::size_t segments,
          double mother_um, double end_um, HashRandom& draws);

  double diameter_um(std::size_t segment) const;

private:
  double mean_um_;
  double first_um_; // above the mean
  double step_um_;  // decrease per fork
  double least_um_;
  double most_um_;
};

// A segment's length: of four samples from the published distribution, the one nearest to what the
// vessel needs. Most vessels need more than the mean, so lengths average about one deviation above
// it; otherwise the published number of vessels would not reach all of the muscle.
double segment_length_mm(const OrderMorphometry& order, double needed_mm, HashRandom& draws);

// The direction of a daughter that heads for `target` (unit vectors). Its angle to the mother is
// about the one with the least work for maintenance and perfusion (Murray, J Gen Physiol 9, 1926),
// which follows from the three diameters.
Vector3 daughter_direction(Vector3 mother, Vector3 target, double mother_um, double daughter_um,
                           double sister_um);

// Continues towards `target`, turning no further than this cosine, and winding a little.
Vector3 onward_direction(Vector3 direction, Vector3 target, double least_cosine, double winding,
                         HashRandom& draws);

} // namespace octascope::sim
