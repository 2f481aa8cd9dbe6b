#include "pipeline/vessels/tracing/wall_distance.h"

#include <algorithm>
#include <cmath>

#include "pipeline/vessels/stoppable.h"

namespace octascope::pipeline {

namespace {

// Longer than any vessel is wide; where no wall is found at all.
constexpr float far_square = 1e12F;

} // namespace

std::vector<float> wall_distances(const FlowingVoxels& voxels, const FlowGrid& grid,
                                  const std::stop_token& stop) {
  std::vector<float> squares(voxels.size(), far_square);
  std::vector<float> along(voxels.size());
  StopCheck stopped{stop};
  for (const std::size_t axis : {std::size_t{2}, std::size_t{0}, std::size_t{1}}) {
    const std::ptrdiff_t step = voxels.steps()[axis];
    const auto spacing = static_cast<float>(grid.spacing_um[axis]);
    for (std::uint32_t voxel = 0; voxel < voxels.size(); ++voxel) {
      float least = squares[voxel];
      const int at = voxels.place(voxel)[axis];
      const auto cell = static_cast<std::ptrdiff_t>(voxels.cell_of(voxel));
      for (const int way : {-1, 1}) {
        const int room = way < 0 ? at : grid.counts[axis] - 1 - at;
        for (int k = 1; k <= room; ++k) {
          const float distance = static_cast<float>(k) * spacing;
          if (distance * distance >= least)
            break;
          const std::uint32_t other =
              voxels.voxel_at(static_cast<std::size_t>(cell + k * way * step));
          const bool wall = other == FlowingVoxels::none;
          least = std::min(least, distance * distance + (wall ? 0.0F : squares[other]));
          if (wall)
            break;
        }
      }
      along[voxel] = least;
      if (stopped())
        return along;
    }
    std::swap(squares, along);
  }
  const auto half = static_cast<float>(grid.narrowest_um() / 2);
  std::ranges::transform(squares, squares.begin(),
                         [half](float square) { return std::max(std::sqrt(square) - half, half); });
  return squares;
}

} // namespace octascope::pipeline
