// The parameters of one picture for the splatting kernels.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "pipeline/vessels/clusters.h"
#include "ui/depth_mask/depth_image.h"
#include "ui/vessels/scene/vessel_scene.h"
#include "ui/vessels/splatter/occlusion_field.h"
#include "ui/view/segment_counts.h"

namespace octascope::ui {

// A row of an affine map of the tree's frame: dot(xyz, place) + w.
using AffineRow = std::array<double, 4>;

// A base colour with 10 bits per channel, red lowest. The flag above them marks segments that are
// drawn with at least least_vessel_radius_px.
using BaseColour = std::uint32_t;
inline constexpr BaseColour kept_visible = 1U << 30U;

// What became of the segments; see SegmentCounts.
struct SplatCounts {
  std::uint64_t splatted = 0;
  std::uint64_t merged = 0;
  std::uint64_t culled = 0;
};

// Read past the end of a picture, by registers.
inline constexpr std::size_t spare_pixels = 32;

struct SplatFrame {
  pipeline::VesselClusters tree;
  // Per cluster: the number of first nodes, references included, whose segments are drawn
  // elsewhere. Empty: none.
  std::span<const std::uint8_t> taken;
  float detail_px = 0; // see merged_order.h; 0: every segment is drawn
  // The sharp picture (splat_outline.h), with spare_pixels after the last, and the smoothed one.
  DepthPixel* pixels = nullptr;
  DepthPixel* smooth = nullptr;
  bool within_volume = false; // see SplatShare
  OcclusionMoments occlusion;
  int width = 0;
  int height = 0;
  // Pixel centres are at whole numbers, rows from the top: column = column_row / distance_row.
  AffineRow column_row{};
  AffineRow line_row{};
  AffineRow distance_row{}; // along the view, in mm
  float pixels_per_unit = 0;
  float middle_column = 0; // the pixel straight ahead of the eye
  float middle_line = 0;
  float near_mm = 0;
  float far_mm = 0;
  VesselLook look;
  std::array<std::array<BaseColour, 16>, pipeline::vessel_branch_count>
      colours{}; // [branch][order]
};

} // namespace octascope::ui
