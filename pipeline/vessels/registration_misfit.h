// Whether pairs of points can belong to one tree in one volume at all: a turn and a shift change no
// length and mirror nothing.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "pipeline/vessels/point_registration.h"

namespace octascope::pipeline {

inline constexpr double largest_coordinate_mm = 1e6; // of a point: nobody's anatomy

// In words what speaks against the pairs; nothing if a rigid motion explains them. Each is told
// from noise at the level of one in a thousand, the noise being what the better explanation leaves
// over in N pairs:
// - A scale: the spreads of both sides differ by more than 5 % and by more than Student's t with
//   3N − 7 degrees of freedom times the scale's standard error.
// - A mirrored frame: a reflection leaves over so much less that the ratio of the squares exceeds
//   Fisher's F with 3N − 6 and 3N − 6, and a turn leaves over more than 2 % of the spread. Never for
//   points in a plane, which a reflection leaves alone.
// - Neither, but the residual is above half of the spread: the pairs do not belong together.
// `registration` is register_points()'s of the same pairs.
std::optional<std::string> misfit_of(std::span<const PointPair> pairs,
                                     const PointRegistration& registration);

} // namespace octascope::pipeline
