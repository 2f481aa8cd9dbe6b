// One frame's camera, in the form needed to project the packed nodes of clusters.
#pragma once

#include <array>
#include <cstdint>

#include <glm/vec4.hpp>

#include "ui/vessels/scene/vessel_scene.h"

namespace octascope::ui {

// A point of the tree (x, y, z in mm, 1) projects to the pixel (across / along, up / along), rows
// from the bottom as in GL, pixel centres at halves; `along` is its distance along the view in mm.
struct VesselFrame {
  glm::dvec4 across;
  glm::dvec4 up;
  glm::dvec4 along;
  double pixels_per_unit = 0; // as VesselScene
  float near_mm = 0;
  float far_mm = 0;
  // Normalised device depth is depth_offset + depth_scale / distance along the view.
  float depth_offset = 0;
  float depth_scale = 0;
  float width = 0;
  float height = 0;
  // The pixel straight ahead of the eye; for stereo eyes not the picture's middle.
  float middle_x = 0;
  float middle_y = 0;
  VesselLook look;
};

VesselFrame make_vessel_frame(const VesselScene& scene);

// Where the order colours of vessel_look.h start in the shaders' palette.
inline constexpr std::uint32_t palette_of_orders = pipeline::vessel_branch_count;
inline constexpr std::uint32_t palette_of_gl = palette_of_orders + pipeline::vessel_order_count;
inline constexpr std::uint32_t palette_of_processor = palette_of_gl + 1;
inline constexpr std::size_t palette_size = palette_of_processor + 1;
inline constexpr std::uint32_t colour_by_order = 0xFF;
std::array<VesselColour, palette_size> vessel_palette();

// A cluster in a frame: the coefficients for its packed nodes. A record of a vertex buffer.
struct PlacedCluster {
  // For a packed place (x, y, z): [0] + [1] · x + [2] · y + [3] · z gives the frame's across, up
  // and along.
  std::array<float, 4> across;
  std::array<float, 4> up;
  std::array<float, 4> along;
  float smallest_radius; // in pixels, at 1 mm along the view
  float log2_radius_step;
  std::uint32_t first_node;
  std::uint32_t references;
  std::uint32_t segments; // to be drawn: the first ones after the references
  std::uint32_t colour;   // index in the palette, or colour_by_order
};
static_assert(sizeof(PlacedCluster) == 72);

// With the colour for what GL expands.
PlacedCluster place_cluster(const VesselFrame& frame, const pipeline::VesselCluster& cluster,
                            std::uint32_t segments);

// The palette index for a segment that the processor expands.
std::uint32_t expanded_colour(const VesselFrame& frame, const PlacedCluster& cluster,
                              pipeline::PackedNode node);

} // namespace octascope::ui
