#include "ui/volume/slice_spacing.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <glm/common.hpp>

namespace octascope::ui {

float SliceSpacing::offset_mm(int i) const {
  const int from_first = direction > 0 ? i : drawn - 1 - i;
  // The voxel in whose stretch of the axis the middle of the i-th share lies.
  const auto voxel = static_cast<float>((std::int64_t{2 * from_first + 1} * slices) / (2 * drawn));
  return ((voxel + 0.5F) / static_cast<float>(slices) * 2 - 1) * half_mm;
}

SliceSpacing space_slices(const Camera& camera, const pipeline::VolumeGeometry& g, float step_mm,
                          int most) {
  const glm::vec3 along = glm::abs(camera.forward);
  SliceSpacing spacing{};
  spacing.axis = along.x >= along.y && along.x >= along.z ? 0 : along.y >= along.z ? 1 : 2;
  spacing.direction = camera.forward[spacing.axis] < 0 ? -1.0F : 1.0F;
  const int counts[] = {g.a_scans, g.depths, g.b_scans};
  spacing.slices = counts[spacing.axis];
  const float extent = box_extents_mm(g)[spacing.axis];
  // A hair more than the quotient: a step of exactly one slice draws each of them.
  const float asked = std::ceil(extent / step_mm - 1e-3F);
  spacing.drawn = std::max(1, std::min({spacing.slices, most, static_cast<int>(asked)}));
  spacing.spacing_mm = extent / static_cast<float>(spacing.drawn);
  spacing.half_mm = extent / 2;
  return spacing;
}

} // namespace octascope::ui
