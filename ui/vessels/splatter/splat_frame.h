// The splatting kernels' input for one picture.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "pipeline/vessels/clusters.h"
#include "ui/depth_mask/depth_image.h"
#include "ui/vessels/scene/vessel_scene.h"
#include "ui/view/segment_counts.h"

namespace octascope::ui {

// Row of an affine map of the tree's frame: dot(xyz, place) + w.
using AffineRow = std::array<double, 4>;

// Base colours with 10 bits a channel, red lowest; the flag in the two bits above marks segments to
// be drawn at least least_vessel_radius_px wide.
using BaseColour = std::uint32_t;
inline constexpr BaseColour kept_visible = 1U << 30U;

// Where the segments went; see SegmentCounts.
struct SplatCounts {
  std::uint64_t splatted = 0;
  std::uint64_t merged = 0;
  std::uint64_t culled = 0;
};

struct SplatFrame {
  pipeline::VesselClusters tree;
  // Per cluster, the number of its first nodes, references included, whose segments are drawn
  // elsewhere. Empty: none.
  std::span<const std::uint8_t> taken;
  float detail_px = 0; // see merged_order.h; 0: every segment is drawn
  DepthPixel* pixels = nullptr;
  int width = 0;
  int height = 0;
  // Pixel centres are whole numbers, rows run from the top: column = column_row / distance_row.
  AffineRow column_row{};
  AffineRow line_row{};
  AffineRow distance_row{}; // along the view, in mm
  float pixels_per_unit = 0;
  float middle_column = 0; // straight ahead of the eye
  float middle_line = 0;
  float near_mm = 0;
  float far_mm = 0;
  VesselLook look;
  std::array<std::array<BaseColour, 16>, pipeline::vessel_branch_count>
      colours{}; // [branch][order]
};

} // namespace octascope::ui
