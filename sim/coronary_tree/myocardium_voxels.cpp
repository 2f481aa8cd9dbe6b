#include "sim/coronary_tree/myocardium_voxels.h"

#include "sim/coronary_tree/hash_random.h"
#include "sim/coronary_tree/heart/heart_wall.h"

namespace octascope::sim {
namespace {

using Distances = std::array<double, 3>;

std::size_t nearest_artery(const Distances& distances, const Distances& shifts) {
  std::size_t best = 0;
  for (std::size_t i = 1; i < 3; ++i)
    if (distances[i] + shifts[i] < distances[best] + shifts[best])
      best = i;
  return best;
}

Distances balanced_shifts(std::span<const Distances> distances, const Distances& shares) {
  constexpr int rounds = 60;
  constexpr double step_mm = 6;
  Distances shifts{};
  for (int round = 0; round < rounds; ++round) {
    Distances counts{};
    for (const Distances& d : distances)
      ++counts[nearest_artery(d, shifts)];
    for (std::size_t i = 0; i < 3; ++i)
      shifts[i] += step_mm * (counts[i] / static_cast<double>(distances.size()) - shares[i]);
  }
  return shifts;
}

double part(double x) {
  return x - std::floor(x);
}

} // namespace

std::vector<Vector3> myocardium_voxels() {
  // A box that holds both ventricles.
  constexpr Vector3 least{-48, -64, -32};
  constexpr Vector3 most{34, base_mm, 46};
  std::vector<Vector3> cells;
  for (double y = least.y; y < most.y; y += cell_mm)
    for (double z = least.z; z < most.z; z += cell_mm)
      for (double x = least.x; x < most.x; x += cell_mm)
        if (in_muscle({x, y, z}))
          cells.push_back({x, y, z});
  return cells;
}

std::array<std::size_t, 3> share_out(std::vector<Vector3>& cells,
                                     const std::array<Course, 3>& courses,
                                     const std::array<double, 3>& shares) {
  std::vector<Distances> distances;
  distances.reserve(cells.size());
  for (const Vector3& p : cells)
    distances.push_back({courses[0].nearest(p).distance_mm, courses[1].nearest(p).distance_mm,
                         courses[2].nearest(p).distance_mm});
  const Distances shifts = balanced_shifts(distances, shares);
  std::array<std::vector<Vector3>, 3> of_artery;
  for (std::size_t i = 0; i < cells.size(); ++i)
    of_artery[nearest_artery(distances[i], shifts)].push_back(cells[i]);
  cells.clear();
  for (const auto& some : of_artery)
    cells.insert(cells.end(), some.begin(), some.end());
  return {of_artery[0].size(), of_artery[1].size(), of_artery[2].size()};
}

std::vector<Vector3> places_in_cells(std::span<const Vector3> cells, std::size_t count,
                                     std::uint64_t key) {
  // Multiples of the powers of the plastic number fill a cube evenly (Roberts, 2018).
  constexpr double p1 = 0.8191725133961645;
  constexpr double p2 = 0.6710436067037893;
  constexpr double p3 = 0.5497004779019703;
  HashRandom draws{key};
  const double u = draws.unit();
  const double v = draws.unit();
  const double w = draws.unit();
  std::vector<Vector3> places;
  places.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const Vector3 cell = cells[i * cells.size() / count];
    const auto n = static_cast<double>(i);
    const Vector3 p = cell + cell_mm * Vector3{part(u + n * p1) - 0.5, part(v + n * p2) - 0.5,
                                               part(w + n * p3) - 0.5};
    places.push_back(held_in_muscle(p));
  }
  return places;
}

} // namespace octascope::sim
