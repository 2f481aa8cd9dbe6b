// The rigid transform that brings one set of points onto another.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "hal/result.h"
#include "pipeline/vessels/rigid_transform.h"

namespace octascope::pipeline {

inline constexpr std::size_t fewest_point_pairs = 3;

// The same spot in the tree's frame and in the volume's, in mm.
struct PointPair {
  Point tree;
  Point volume;
};

struct PointRegistration {
  RigidTransform volume_from_tree;
  std::vector<double> residuals_mm; // by pair: distance left over
  double rms_mm = 0;
  double largest_mm = 0;
  // How well the other pairs tell where each one is, by pair: nearer to what a vessel that was not
  // marked is off by than the residual, which the fit has made small. Empty where there are but
  // three pairs, or where without one of them the rest lie on a line.
  std::vector<double> left_out_mm;
  std::optional<double> left_out_rms_mm;
};

// Least squares, in closed form: B. K. P. Horn, "Closed-form solution of absolute orientation using
// unit quaternions", J Opt Soc Am A 4, 1987. Never mirrors. ErrorCode::invalid_argument for fewer
// than three pairs, and for points that coincide or lie on a line, about which the tree could turn.
hal::Result<PointRegistration> register_points(std::span<const PointPair> pairs);

// The transform alone, of at least three pairs.
hal::Result<RigidTransform> fit_points(std::span<const PointPair> pairs);

// The root mean square of the distances that the transform leaves.
double rms_distance_mm(const RigidTransform& transform, std::span<const PointPair> pairs);

} // namespace octascope::pipeline
