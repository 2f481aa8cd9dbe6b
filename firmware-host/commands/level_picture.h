// A B-scan as a picture, for looking at on a desk; the display draws with its own window.
#pragma once

#include <span>

#include "pipeline/png_image.h"

namespace octascope::firmware_host {

// `levels_db` is [a][z]. Rows are depths, columns A-scans, one pixel a level. Black is the median,
// which is mostly noise, white the level that one voxel in a thousand exceeds; of the first
// depths, up to a hundredth, none counts: what is left of the background is there.
pipeline::Image draw_b_scan(std::span<const float> levels_db, int depths, int a_scans);

} // namespace octascope::firmware_host
