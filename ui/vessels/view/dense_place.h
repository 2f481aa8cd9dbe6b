// Finds the densest part of a vessel tree.
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "pipeline/vessels/clusters.h"

namespace octascope::ui {

// Among boxes of `size_mm` along `axes` (orthonormal columns), placed at a quarter of their size
// and with something in their first corner, takes the one with the most segments, and returns the
// mean position of its segments. A cluster's segments count as in its middle. The origin for an
// empty tree. Allocates: for commands.
glm::vec3 densest_place(const pipeline::VesselClusters& tree, const glm::mat3& axes,
                        const glm::vec3& size_mm);

} // namespace octascope::ui
