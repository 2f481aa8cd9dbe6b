// Where a vessel tree is densest.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "pipeline/vessels/clusters.h"

namespace octascope::ui {

// Of boxes `size_mm` along the axes (unit vectors at right angles, the columns), a quarter of their
// size apart, with something in their first corner: the one that holds most segments, and of it the
// mean place of its segments. A cluster's segments are taken to be in its middle. The origin for an
// empty tree. For commands: allocates.
glm::vec3 densest_place(const pipeline::VesselClusters& tree, const glm::mat3& axes,
                        const glm::vec3& size_mm);

} // namespace octascope::ui
