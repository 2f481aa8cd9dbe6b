#include "pipeline/vessels/registration_misfit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include <fmt/format.h>

namespace octascope::pipeline {
namespace {

constexpr double smallest_scale_fault = 0.05;
constexpr double smallest_mirror_fault = 0.02; // left over by a turn, of the spread
constexpr double largest_residual = 0.5;       // of the spread

// 0.999 quantiles by the number of pairs from 3 on: two-sided t with 3N − 7 degrees of freedom, F
// with 3N − 6 and 3N − 6. More pairs than these have the last ones, which are a little too large.
constexpr std::array students_t{31.6, 6.87, 5.04, 4.44, 4.14, 3.97};
constexpr std::array fishers_f{999.0, 20.0, 10.1, 7.0, 5.6, 4.7};

template <std::size_t N> double by_pairs(const std::array<double, N>& table, std::size_t pairs) {
  return table[std::min(pairs - fewest_point_pairs, N - 1)];
}

// Root of the mean square distance from the middle.
double spread(std::span<const PointPair> pairs, Point PointPair::*side) {
  const auto count = static_cast<double>(pairs.size());
  Point middle{};
  for (const PointPair& pair : pairs)
    for (std::size_t axis = 0; axis < 3; ++axis)
      middle[axis] += (pair.*side)[axis] / count;
  double squares = 0;
  for (const PointPair& pair : pairs)
    for (std::size_t axis = 0; axis < 3; ++axis)
      squares += std::pow((pair.*side)[axis] - middle[axis], 2);
  return std::sqrt(squares / count);
}

struct Fit {
  RigidTransform transform;
  double rms_mm = 0;
};

// Of the tree scaled, and mirrored at z = 0. Nothing where two turns fit as well.
std::optional<Fit> fit_of(std::span<const PointPair> pairs, double scale, bool mirrored) {
  std::vector<PointPair> changed(pairs.begin(), pairs.end());
  for (PointPair& pair : changed) {
    for (double& c : pair.tree)
      c *= scale;
    if (mirrored)
      pair.tree[2] = -pair.tree[2];
  }
  const auto transform = fit_points(changed);
  if (!transform)
    return std::nullopt;
  return Fit{*transform, rms_distance_mm(*transform, changed)};
}

std::string in_words(double tree_over_volume) {
  const auto about = [&](double factor) { return std::fabs(tree_over_volume / factor - 1) < 0.1; };
  const bool tree_wider = tree_over_volume > 1;
  std::string words = fmt::format(
      "the {} points spread {:.4g} times as wide as the {}", tree_wider ? "tree's" : "volume's",
      tree_wider ? tree_over_volume : 1 / tree_over_volume, tree_wider ? "volume's" : "tree's");
  if (about(1000))
    words += ": is the tree in micrometres?";
  else if (about(1e-3))
    words += ": is the volume in micrometres, or the tree in metres?";
  else if (about(10) || about(0.1))
    words += fmt::format(": is the {} in centimetres?", tree_wider ? "volume" : "tree");
  return words;
}

// The axes that a reflection turns about or exchanges, if it does no more than that: it is
// 1 − 2 n nᵀ, and n lies along an axis or between two.
std::string axes_of(const RigidTransform& turn) {
  auto mirror = turn.rotation;
  for (auto& row : mirror)
    row[2] = -row[2];
  constexpr double trace = 1; // of a reflection
  constexpr double near = 0.05;
  if (std::fabs(mirror[0][0] + mirror[1][1] + mirror[2][2] - trace) > near)
    return {};
  constexpr std::array names{"x", "y", "z"};
  for (std::size_t a = 0; a < 3; ++a) {
    const std::size_t b = (a + 1) % 3;
    if (mirror[a][a] < -1 + near)
      return fmt::format(": does {} run the other way?", names[a]);
    if (mirror[a][b] > 1 - near)
      return fmt::format(": are {} and {} exchanged?", names[std::min(a, b)],
                         names[std::max(a, b)]);
  }
  return {};
}

} // namespace

std::optional<std::string> misfit_of(std::span<const PointPair> pairs,
                                     const PointRegistration& registration) {
  const auto count = static_cast<double>(pairs.size());
  const double wide = spread(pairs, &PointPair::volume);
  const double scale = wide / spread(pairs, &PointPair::tree);
  const auto turned = fit_of(pairs, scale, false);
  const auto mirrored = fit_of(pairs, scale, true);
  const double least = std::min(turned ? turned->rms_mm : registration.rms_mm,
                                mirrored ? mirrored->rms_mm : registration.rms_mm);
  const double noise_mm = least * std::sqrt(count / (3 * count - 7)); // of a coordinate
  const double error = noise_mm / (wide * std::sqrt(count));          // of the scale's logarithm
  const bool other_scale =
      std::fabs(std::log(scale)) >
      std::max(std::log1p(smallest_scale_fault), by_pairs(students_t, pairs.size()) * error);
  const auto as_turned =
      other_scale ? turned : Fit{registration.volume_from_tree, registration.rms_mm};
  const auto as_mirrored = other_scale ? mirrored : fit_of(pairs, 1, true);
  const double factor = std::sqrt(by_pairs(fishers_f, pairs.size()));
  const bool is_mirrored =
      as_mirrored && (!as_turned || (as_turned->rms_mm > factor * as_mirrored->rms_mm &&
                                     as_turned->rms_mm > smallest_mirror_fault * wide));
  std::string words;
  if (other_scale)
    words = in_words(1 / scale);
  if (is_mirrored)
    words += fmt::format("{}one side is mirrored{} (a reflection leaves {:.3g} mm over, a turn "
                         "{:.3g} mm)",
                         other_scale ? "; and " : "", axes_of(as_mirrored->transform),
                         as_mirrored->rms_mm, as_turned ? as_turned->rms_mm : registration.rms_mm);
  if (words.empty() && registration.rms_mm > largest_residual * wide)
    words = fmt::format("the residual of {:.4g} mm is more than half of the {:.4g} mm that the "
                        "points spread: do the pairs belong together, line by line?",
                        registration.rms_mm, wide);
  return words.empty() ? std::nullopt : std::optional{words};
}

} // namespace octascope::pipeline
