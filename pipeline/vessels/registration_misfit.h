// Whether a rigid motion can explain pairs of points: it changes no length and mirrors nothing.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "pipeline/vessels/point_registration.h"

namespace octascope::pipeline {

inline constexpr double largest_coordinate_mm = 1e6; // of a point: beyond any anatomy

// What is wrong with the pairs, in words; empty if a rigid motion explains them. N pairs must show
// one of these at a significance of 0.001, with the residuals of the better explanation as noise:
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
