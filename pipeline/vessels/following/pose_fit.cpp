#include "pipeline/vessels/following/pose_fit.h"

#include <array>
#include <cmath>
#include <cstddef>

#include "pipeline/vessels/following/pose_search.h"
#include "pipeline/vessels/vectors.h"

namespace octascope::pipeline {

namespace {

double biweight(double distance_mm, double reach_mm) {
  const double share = distance_mm / reach_mm;
  return share < 1 ? (1 - share * share) * (1 - share * share) : 0;
}

// Six equations for a turn and a shift.
class NormalEquations {
public:
  // That `off` becomes zero along each axis, at `arm` from the middle of the turn, across `along`.
  void add(const Point& arm, const Point& along, const Point& off, double weight) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      // How the component of `off` along this axis changes: the axis without its part along the vessel.
      Point across = scaled(along, -along[axis]);
      across[axis] += 1;
      const std::array<double, 6> row{arm[1] * across[2] - arm[2] * across[1],
                                      arm[2] * across[0] - arm[0] * across[2],
                                      arm[0] * across[1] - arm[1] * across[0],
                                      across[0],
                                      across[1],
                                      across[2]};
      for (std::size_t i = 0; i < 6; ++i) {
        for (std::size_t j = 0; j <= i; ++j)
          matrix_[i][j] += weight * row[i] * row[j];
        right_[i] -= weight * row[i] * off[axis];
      }
    }
    weight_ += weight;
  }

  // By Cholesky; a little of the identity keeps what nothing determines as it is.
  std::array<double, 6> solve() const {
    auto l = matrix_;
    auto x = right_;
    for (std::size_t i = 0; i < 6; ++i)
      l[i][i] += 1e-3 * weight_ + 1e-9;
    for (std::size_t i = 0; i < 6; ++i)
      for (std::size_t j = 0; j <= i; ++j) {
        double left = l[i][j];
        for (std::size_t k = 0; k < j; ++k)
          left -= l[i][k] * l[j][k];
        l[i][j] = i == j ? std::sqrt(left) : left / l[j][j];
      }
    for (std::size_t i = 0; i < 6; ++i) {
      for (std::size_t k = 0; k < i; ++k)
        x[i] -= l[i][k] * x[k];
      x[i] /= l[i][i];
    }
    for (std::size_t i = 6; i-- > 0;) {
      for (std::size_t k = i + 1; k < 6; ++k)
        x[i] -= l[k][i] * x[k];
      x[i] /= l[i][i];
    }
    return x;
  }

private:
  std::array<std::array<double, 6>, 6> matrix_{}; // the lower half
  std::array<double, 6> right_{};
  double weight_ = 0;
};

} // namespace

TreeSample moved(const TreeSample& sample, const RigidTransform& pose) {
  TreeSample there = sample;
  there.at = pose.apply(sample.at);
  for (std::size_t row = 0; row < 3; ++row)
    there.along[row] = product(pose.rotation[row], sample.along);
  return there;
}

RigidTransform fit_pose(const SampleGrid& grid, std::span<const TreeSample> samples,
                        const Point& middle, RigidTransform pose, const FitStage& stage) {
  for (int i = 0; i < stage.iterations; ++i) {
    const Point centre = pose.apply(middle);
    NormalEquations equations;
    for (const TreeSample& sample : samples) {
      const TreeSample there = moved(sample, pose);
      if (const auto beside = grid.nearest(there.at, there.along, stage.reach_mm))
        equations.add(difference(there.at, centre), beside->sample->along, beside->off,
                      biweight(beside->distance_mm, stage.reach_mm) * sample.length_mm);
    }
    const auto step = equations.solve();
    pose = turned_about(centre, {step[0], step[1], step[2]}, {step[3], step[4], step[5]}) * pose;
    constexpr double still_mm = 1e-5;
    if (length({step[0], step[1], step[2]}) < still_mm &&
        length({step[3], step[4], step[5]}) < still_mm)
      break;
  }
  return pose;
}

double pose_score(const SampleGrid& grid, std::span<const TreeSample> samples,
                  const RigidTransform& pose, double reach_mm) {
  double found = 0, whole = 0;
  for (const TreeSample& sample : samples) {
    whole += sample.length_mm;
    const TreeSample there = moved(sample, pose);
    if (const auto beside = grid.nearest(there.at, there.along, reach_mm))
      found += biweight(beside->distance_mm, reach_mm) * sample.length_mm;
  }
  return whole > 0 ? found / whole : 0;
}

} // namespace octascope::pipeline
