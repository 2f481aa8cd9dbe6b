// Projections along depth, for the en-face picture. Pure.
#pragma once

#include <cstdint>
#include <span>

#include "pipeline/volume/volume.h"

namespace octascope::ui {

// The sum of levels of every A-scan. `out` holds [b][a], a_scans · b_scans values.
void project_sum(const pipeline::Volume& volume, std::span<std::uint32_t> out);

// Grey values from sums: the darkest 1 % of the A-scans present become 0 and the brightest 1 % 255,
// linear between. The display window does not apply: it is for single voxels, whose mean lies in a
// much narrower range that depends on how much of the depth is tissue.
void stretch_contrast(const pipeline::Volume& volume, std::span<const std::uint32_t> sums,
                      std::span<std::uint8_t> out);

} // namespace octascope::ui
