#include "ui/vessels/view/dense_place.h"

#include <array>
#include <map>

#include <glm/common.hpp>
#include <glm/matrix.hpp>

namespace octascope::ui {

namespace {

constexpr int cells_across = 4; // of the box

struct Held {
  double segments = 0;
  glm::dvec3 moment{0}; // Σ segments · place
};
using Cell = std::array<int, 3>;
using Cells = std::map<Cell, Held>; // ordered: the same place in every run

glm::vec3 middle_of(const pipeline::VesselCluster& cluster) {
  glm::vec3 middle;
  for (int axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<std::size_t>(axis);
    middle[axis] = cluster.origin_mm[i] +
                   0.5F * cluster.step_mm[i] * static_cast<float>(pipeline::vessel_place_steps);
  }
  return middle;
}

Cells sorted_into_cells(const pipeline::VesselClusters& tree, const glm::mat3& from_tree,
                        const glm::vec3& cell_mm) {
  Cells cells;
  for (const pipeline::VesselCluster& cluster : tree.clusters) {
    const glm::vec3 place = from_tree * middle_of(cluster);
    const glm::vec3 cell = glm::floor(place / cell_mm);
    Held& held =
        cells[{static_cast<int>(cell.x), static_cast<int>(cell.y), static_cast<int>(cell.z)}];
    held.segments += cluster.segments();
    held.moment += glm::dvec3{place} * static_cast<double>(cluster.segments());
  }
  return cells;
}

// What the box holds whose first cell this is.
Held held_from(const Cells& cells, const Cell& first) {
  Held sum;
  for (int x = 0; x < cells_across; ++x)
    for (int y = 0; y < cells_across; ++y) {
      const Cell from{first[0] + x, first[1] + y, first[2]};
      for (auto at = cells.lower_bound(from);
           at != cells.end() && at->first < Cell{from[0], from[1], from[2] + cells_across}; ++at) {
        sum.segments += at->second.segments;
        sum.moment += at->second.moment;
      }
    }
  return sum;
}

} // namespace

glm::vec3 densest_place(const pipeline::VesselClusters& tree, const glm::mat3& axes,
                        const glm::vec3& size_mm) {
  const Cells cells =
      sorted_into_cells(tree, glm::transpose(axes), size_mm / static_cast<float>(cells_across));
  Held best;
  for (const auto& cell : cells)
    if (const Held here = held_from(cells, cell.first); here.segments > best.segments)
      best = here;
  return best.segments > 0 ? axes * glm::vec3{best.moment / best.segments} : glm::vec3{0};
}

} // namespace octascope::ui
