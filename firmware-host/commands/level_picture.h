// B-scans and volumes from above as pictures for export and inspection; the display draws its own.
#pragma once

#include <optional>
#include <span>

#include "hal/result.h"
#include "pipeline/files/png_image.h"
#include "pipeline/volume/volume.h"
#include "ui/transfer/auto_window.h"

namespace octascope::firmware_host {

// `levels_db` is [a][z]. Rows are depths, columns A-scans, one pixel a level. Black is the median,
// which is mostly noise; white is the level that one voxel in a thousand exceeds. The first
// hundredth of the depths is ignored for both: it holds what is left of the background.
pipeline::Image draw_b_scan(std::span<const float> levels_db, int depths, int a_scans);

// The same for a volume's B-scan: black where the window begins, white where it ends.
pipeline::Image draw_b_scan(const pipeline::Volume& volume, int b_scan,
                            const ui::DisplayWindow& window);

// From above: the display's en-face picture, one pixel an A-scan, the fast axis to the right, the
// first B-scan at the top. Scaled by the window or, without one, with the display's contrast.
pipeline::Image draw_en_face(const pipeline::Volume& volume,
                             const std::optional<ui::DisplayWindow>& window);

// Square pixels of the smaller spacing; pixels are repeated along the axis with the larger one.
// ErrorCode::invalid_argument: the picture would be too large.
hal::Result<pipeline::Image> to_scale(const pipeline::Image& grey, double column_spacing,
                                      double row_spacing);

} // namespace octascope::firmware_host
