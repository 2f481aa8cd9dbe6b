// The parameters of one picture for the ray-casting kernels.
#pragma once

#include <cstdint>
#include <limits>

namespace octascope::ui {

// Depth of pixels whose rays accumulate less than half an opacity.
inline constexpr float no_depth = std::numeric_limits<float>::infinity();

// A ray ends below this transparency. The remainder counts as having the colour accumulated so far,
// so a picture errs by at most a 128th of the difference between the two colours.
inline constexpr float opaque_transparency = 1.0F / 128;

// Of "shaded": brightness lost at the far end of the box.
inline constexpr float depth_cue = 0.4F;

// Of the polynomial from grey to opacity.
inline constexpr int ramp_terms = 6;

// Axes in the order depth, fast, slow. Lengths along them are in cells
// (pipeline/volume/occupancy.h), so the middle of depth bin 0 is at 0, the middles of A-scan 0 and
// B-scan 0 are at 1. Pointers are borrowed.
struct RayFrame {
  // The volume.
  const std::uint8_t* cells;
  std::int32_t column_bytes;
  std::int32_t row_bytes;
  const std::uint16_t* bricks; // numbers of DistancesAhead
  std::int32_t brick_row;      // stride in bricks along the fast axis
  std::int32_t brick_slab;     // … along the slow axis
  std::int32_t brick_octant;   // … between octants
  float lower[3];              // the box that is shown
  float upper[3];
  bool is_cut;
  float cut[2]; // RayGeometry::cut

  // What flows. Only kernels of flow read it.
  const std::uint8_t* flow; // FlowCells
  std::int32_t flow_column;
  std::int32_t flow_slab;
  std::int32_t last_a;
  std::int32_t last_b;
  const std::uint32_t* flow_marks;
  std::int32_t mark_row;
  std::int32_t mark_slab;
  const std::uint16_t* flow_bricks;
  const std::uint32_t* flow_opacity_and_weight; // FlowTable
  bool coarse_beside_flow;                      // RaySettings::coarse_beside_flow

  // The transfer function.
  const std::uint32_t* opacity_and_red;
  const std::uint32_t* green_and_blue;
  // The same as a display window: grey = clamp(scale · level + offset), level as 1/2^22, and the
  // opacity of one step is grey · (polynomial in grey), lowest power first.
  float ramp_scale;
  float ramp_offset;
  float ramp_opacity[ramp_terms];

  // Colour by depth (ui/transfer/depth_colours.h): the place is scale · cells along the depth + offset.
  bool by_depth;
  float tint_scale;
  float tint_offset;

  // The eye.
  float eye[3];
  float forward[3]; // cells per mm
  float right[3];
  float up[3];
  float pixel_width; // at distance 1
  float pixel_height;
  float centre_shift; // of the picture's middle to the right of `forward`, at distance 1
  float near_mm;
  float step_mm;
  const float* dither; // ui/dither/dither_mask.h

  // Shading. Null: by depth alone.
  const std::uint32_t* light; // the texels of LightVolume
  struct LightAxis {
    float scale; // from cells to texels
    float offset;
    std::int32_t count;
    std::int32_t stride;
  };
  LightAxis light_axes[3];
  float lamp[3]; // the direction to it, in mm
  float mm[3];   // of one cell
  float cue_near_mm;
  float cue_per_mm;

  // The picture, rows from the top.
  int width;
  int height;
  std::uint32_t* rgba; // premultiplied, red in the lowest 8 bits
  // Where rays end, per pixel: the bits of a distance along the view, in the upper half of each
  // (ui/depth_mask/depth_image.h). Null: only at the end of the volume.
  const std::uint64_t* stops;
  float* depth_mm; // along the view; no_depth where there is nothing
};

} // namespace octascope::ui
