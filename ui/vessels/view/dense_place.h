// Where a vessel tree is densest.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "pipeline/vessels/clusters.h"

namespace octascope::ui {

// Of boxes of `size_mm` along the axes (perpendicular unit vectors, the columns), placed a quarter
// of their size apart wherever their first corner holds something: takes the one with the most
// segments and returns their mean place. A cluster's segments count at its middle. The origin for
// an empty tree. For commands: allocates.
glm::vec3 densest_place(const pipeline::VesselClusters& tree, const glm::mat3& axes,
                        const glm::vec3& size_mm);

} // namespace octascope::ui
