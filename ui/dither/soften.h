// Averages the neighbouring pixels of a picture whose rays are dithered (dither_mask.h): each shows
// samples at other places, together they show as many as all of their steps. A picture of few steps
// is soft then, and not grained.
//
// Source: A. Keller, W. Heidrich, "Interleaved sampling", Eurographics Workshop on Rendering (2001).
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>

#include "ui/depth_mask/depth_image.h"
#include "ui/layout/layout.h"
#include "ui/view/camera.h"

namespace octascope::ui {

inline constexpr int soften_radius = 1; // pixels: 3 × 3 are averaged, by 1, 2, 1 each way

// Whether samples so far apart show grain. At full quality (512 along the longest edge) they do not,
// and the picture stays as sharp as it is.
inline bool is_grained(float step_mm, const pipeline::VolumeGeometry& volume) {
  constexpr float fine = 1.0F / 448;
  const glm::vec3 extents = box_extents_mm(volume);
  return step_mm > fine * std::max({extents.x, extents.y, extents.z});
}

// Pixels of a picture of `width` columns, rows from the top, RGBA of 8 bits, premultiplied.
struct SoftenJob {
  std::span<const std::uint32_t> from;
  std::span<std::uint32_t> to;
  int width;
  Rect drawn; // pixels outside count as those of its border
  // Of the picture's size, or null. A pixel with a vessel is averaged only with such, one without
  // only with such: neither bleeds into the other.
  const DepthImage* stops;
};

// Of the rows of `drawn` from `first` to before `last`. Allocates nothing; others may do other rows
// at the same time.
void soften_rows(const SoftenJob& job, int first, int last);

} // namespace octascope::ui
