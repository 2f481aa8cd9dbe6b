#include "pipeline/vessels/point_registration.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <string_view>

namespace octascope::pipeline {
namespace {

constexpr std::size_t quaternion = 4; // components
template <std::size_t N> using Matrix = std::array<std::array<double, N>, N>;

template <std::size_t N> struct Eigen {
  std::array<double, N> values{}; // falling
  Matrix<N> vectors{};            // by rows
};

// Of a symmetric matrix, by Jacobi's rotations: each sweep brings the elements beside the diagonal
// nearer to zero, from the third on quadratically.
template <std::size_t N> Eigen<N> eigen_of(Matrix<N> m) {
  Matrix<N> vectors{};
  for (std::size_t i = 0; i < N; ++i)
    vectors[i][i] = 1;
  constexpr int sweeps = 30;
  for (int sweep = 0; sweep < sweeps; ++sweep)
    for (std::size_t p = 0; p < N; ++p)
      for (std::size_t q = p + 1; q < N; ++q) {
        if (m[p][q] == 0)
          continue;
        const double theta = (m[q][q] - m[p][p]) / (2 * m[p][q]);
        const double t = std::copysign(1.0, theta) / (std::fabs(theta) + std::hypot(theta, 1.0));
        const double c = 1 / std::hypot(t, 1.0);
        const double s = t * c;
        for (std::size_t k = 0; k < N; ++k) {
          const double kp = m[k][p];
          const double kq = m[k][q];
          m[k][p] = c * kp - s * kq;
          m[k][q] = s * kp + c * kq;
        }
        for (std::size_t k = 0; k < N; ++k) {
          const double pk = m[p][k];
          const double qk = m[q][k];
          m[p][k] = c * pk - s * qk;
          m[q][k] = s * pk + c * qk;
        }
        for (std::size_t k = 0; k < N; ++k) {
          const double vp = vectors[p][k];
          const double vq = vectors[q][k];
          vectors[p][k] = c * vp - s * vq;
          vectors[q][k] = s * vp + c * vq;
        }
      }
  std::array<std::size_t, N> order;
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, [&](std::size_t a, std::size_t b) { return m[a][a] > m[b][b]; });
  Eigen<N> eigen;
  for (std::size_t i = 0; i < N; ++i) {
    eigen.values[i] = m[order[i]][order[i]];
    eigen.vectors[i] = vectors[order[i]];
  }
  return eigen;
}

Point centre_of(std::span<const PointPair> pairs, Point PointPair::*side) {
  Point sum{};
  for (const PointPair& pair : pairs)
    for (std::size_t axis = 0; axis < 3; ++axis)
      sum[axis] += (pair.*side)[axis] / static_cast<double>(pairs.size());
  return sum;
}

// Σ (a − centre of a) (b − centre of b)ᵀ
Matrix<3> products(std::span<const PointPair> pairs, Point PointPair::*a, Point PointPair::*b) {
  const Point centre_a = centre_of(pairs, a);
  const Point centre_b = centre_of(pairs, b);
  Matrix<3> sum{};
  for (const PointPair& pair : pairs)
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j)
        sum[i][j] += ((pair.*a)[i] - centre_a[i]) * ((pair.*b)[j] - centre_b[j]);
  return sum;
}

hal::Result<> check_spread(std::span<const PointPair> pairs, Point PointPair::*side,
                           std::string_view name) {
  const auto values = eigen_of(products(pairs, side, side)).values;
  const auto extent = [&](double value) {
    return std::sqrt(std::max(value, 0.0) / static_cast<double>(pairs.size()));
  };
  const double along = extent(values[0]);
  const double across = extent(values[1]);
  constexpr double narrowest = 0.01; // of the length
  if (along > 0 && across >= narrowest * along)
    return {};
  return hal::fail(
      hal::ErrorCode::invalid_argument,
      "the {} points spread {:.4g} mm along a line and {:.4g} mm across it, expected at least "
      "{:.4g} mm across: the tree could turn about the line; add a point beside it",
      name, along, across, narrowest * along);
}

std::array<std::array<double, 3>, 3> rotation_of(const std::array<double, quaternion>& q) {
  const auto [w, x, y, z] = q;
  return {{{w * w + x * x - y * y - z * z, 2 * (x * y - w * z), 2 * (x * z + w * y)},
           {2 * (x * y + w * z), w * w - x * x + y * y - z * z, 2 * (y * z - w * x)},
           {2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z}}};
}

double distance_left(const RigidTransform& transform, const PointPair& pair) {
  const Point found = transform.apply(pair.tree);
  return std::hypot(found[0] - pair.volume[0], found[1] - pair.volume[1],
                    found[2] - pair.volume[2]);
}

double rms(std::span<const double> values) {
  return std::sqrt(std::inner_product(values.begin(), values.end(), values.begin(), 0.0) /
                   static_cast<double>(values.size()));
}

std::vector<double> leave_each_out(std::span<const PointPair> pairs) {
  std::vector<double> errors;
  std::vector<PointPair> others(pairs.begin(), pairs.end());
  if (pairs.size() <= fewest_point_pairs)
    return errors;
  others.pop_back();
  for (std::size_t i = pairs.size(); i-- > 0;) {
    // `others` are all but pair i.
    const auto transform = fit_points(others);
    if (!transform)
      return {};
    errors.push_back(distance_left(*transform, pairs[i]));
    if (i > 0)
      others[i - 1] = pairs[i];
  }
  std::ranges::reverse(errors);
  return errors;
}

} // namespace

hal::Result<RigidTransform> fit_points(std::span<const PointPair> pairs) {
  HAL_CHECK(check_spread(pairs, &PointPair::tree, "tree's"));
  HAL_CHECK(check_spread(pairs, &PointPair::volume, "volume's"));
  // Horn's matrix N; its greatest eigenvalue's vector is the turn.
  const Matrix<3> s = products(pairs, &PointPair::tree, &PointPair::volume);
  const Matrix<quaternion> n{
      {{s[0][0] + s[1][1] + s[2][2], s[1][2] - s[2][1], s[2][0] - s[0][2], s[0][1] - s[1][0]},
       {s[1][2] - s[2][1], s[0][0] - s[1][1] - s[2][2], s[0][1] + s[1][0], s[2][0] + s[0][2]},
       {s[2][0] - s[0][2], s[0][1] + s[1][0], s[1][1] - s[0][0] - s[2][2], s[1][2] + s[2][1]},
       {s[0][1] - s[1][0], s[2][0] + s[0][2], s[1][2] + s[2][1], s[2][2] - s[0][0] - s[1][1]}}};
  const auto eigen = eigen_of(n);
  if (!(eigen.values[0] - eigen.values[1] > 1e-9 * std::fabs(eigen.values[0])))
    return hal::fail(hal::ErrorCode::invalid_argument,
                     "two turns fit the points equally well, expected one; do the pairs belong "
                     "together, and has no frame mirrored axes?");
  RigidTransform transform;
  transform.rotation = rotation_of(eigen.vectors[0]);
  const Point from = transform.apply(centre_of(pairs, &PointPair::tree));
  const Point to = centre_of(pairs, &PointPair::volume);
  for (std::size_t axis = 0; axis < 3; ++axis)
    transform.shift_mm[axis] = to[axis] - from[axis];
  return transform;
}

double rms_distance_mm(const RigidTransform& transform, std::span<const PointPair> pairs) {
  std::vector<double> distances;
  for (const PointPair& pair : pairs)
    distances.push_back(distance_left(transform, pair));
  return rms(distances);
}

hal::Result<PointRegistration> register_points(std::span<const PointPair> pairs) {
  if (pairs.size() < fewest_point_pairs)
    return hal::fail(hal::ErrorCode::invalid_argument,
                     "found {} pairs of points, expected at least {}", pairs.size(),
                     fewest_point_pairs);
  HAL_TRY(const auto transform, fit_points(pairs));
  PointRegistration registration;
  registration.volume_from_tree = transform;
  for (const PointPair& pair : pairs)
    registration.residuals_mm.push_back(distance_left(transform, pair));
  registration.rms_mm = rms(registration.residuals_mm);
  registration.largest_mm = std::ranges::max(registration.residuals_mm);
  registration.left_out_mm = leave_each_out(pairs);
  if (!registration.left_out_mm.empty())
    registration.left_out_rms_mm = rms(registration.left_out_mm);
  return registration;
}

} // namespace octascope::pipeline
