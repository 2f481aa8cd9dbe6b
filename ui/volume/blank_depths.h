// What pictures of the volume leave out.
#pragma once

namespace octascope::ui {

// Depth bins, from the first: around zero delay the volume holds what is left of the background,
// blurred over two bins by the spectral window, a bright lid over the tissue. B-scan and exports
// show it. Volume pictures begin at the middle of the first bin behind.
inline constexpr int blank_depth_bins = 2;

} // namespace octascope::ui
