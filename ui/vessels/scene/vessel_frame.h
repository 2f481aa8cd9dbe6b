// One frame's camera, in terms of the clusters' packed nodes.
#pragma once

#include <array>
#include <cstdint>

#include <glm/vec4.hpp>

#include "ui/vessels/scene/vessel_scene.h"

namespace octascope::ui {

// A point of the tree (x, y, z in mm, 1) lies at the pixel (across / along, up / along), rows from
// the bottom as GL has them, pixel centres at halves; `along` is its distance along the view in mm.
struct VesselFrame {
  glm::dvec4 across;
  glm::dvec4 up;
  glm::dvec4 along;
  double pixels_per_unit = 0; // as VesselScene
  float near_mm = 0;
  float far_mm = 0;
  // Normalised device depth is offset + scale / distance along the view.
  float depth_offset = 0;
  float depth_scale = 0;
  float width = 0;
  float height = 0;
  // The pixel straight ahead of the eye: not the picture's middle for one of two eyes.
  float middle_x = 0;
  float middle_y = 0;
  VesselLook look;
};

VesselFrame make_vessel_frame(const VesselScene& scene);

// Index of vessel_look.h's colours in the shaders' palette.
inline constexpr std::uint32_t palette_of_orders = pipeline::vessel_branch_count;
inline constexpr std::uint32_t palette_of_gl = palette_of_orders + pipeline::vessel_order_count;
inline constexpr std::uint32_t palette_of_processor = palette_of_gl + 1;
inline constexpr std::size_t palette_size = palette_of_processor + 1;
inline constexpr std::uint32_t colour_by_order = 0xFF;
std::array<VesselColour, palette_size> vessel_palette();

// A cluster in a frame: the factors for its packed nodes. A record of a vertex buffer.
struct PlacedCluster {
  // Of a packed place: [0] + [1] · x + [2] · y + [3] · z is across, up and along of the frame.
  std::array<float, 4> across;
  std::array<float, 4> up;
  std::array<float, 4> along;
  float smallest_radius; // in pixels, at 1 mm along the view
  float log2_radius_step;
  std::uint32_t first_node;
  std::uint32_t references;
  std::uint32_t segments; // to be drawn: this many after the references
  std::uint32_t colour;   // in the palette, or colour_by_order
};
static_assert(sizeof(PlacedCluster) == 72);

// The colour is that for GL's expansion.
PlacedCluster place_cluster(const VesselFrame& frame, const pipeline::VesselCluster& cluster,
                            std::uint32_t segments);

// Palette index of a segment that the processor expands.
std::uint32_t expanded_colour(const VesselFrame& frame, const PlacedCluster& cluster,
                              pipeline::PackedNode node);

} // namespace octascope::ui
