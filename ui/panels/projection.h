// Projections along depth, for the en-face picture. Pure.
#pragma once

#include <cstdint>
#include <span>

#include "pipeline/volume.h"

namespace octascope::ui {

// The highest level of every A-scan. `out` holds [b][a], a_scans · b_scans values.
void project_maximum(const pipeline::Volume& volume, std::span<std::uint8_t> out);

} // namespace octascope::ui
