// Projections along depth, for the en-face picture. Pure.
#pragma once

#include <cstdint>
#include <span>

#include "pipeline/volume/volume.h"

namespace octascope::ui {

// Sums the levels of every A-scan. `out` is [b][a], a_scans · b_scans values.
void project_sum(const pipeline::Volume& volume, std::span<std::uint32_t> out);

// Converts sums to grey values: the darkest 1 % of the received A-scans become 0, the brightest 1 %
// become 255, linear between. The display window is not used: it is for single voxels, whose mean
// lies in a much narrower range that depends on how much of the depth is tissue.
void stretch_contrast(const pipeline::Volume& volume, std::span<const std::uint32_t> sums,
                      std::span<std::uint8_t> out);

} // namespace octascope::ui
