#include "ui/vessels/scene/vessel_frame.h"

#include <algorithm>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace octascope::ui {

namespace {

std::uint32_t colour_of(VesselColouring colouring, pipeline::VesselBranch branch) {
  switch (colouring) {
  case VesselColouring::branch: return static_cast<std::uint32_t>(branch);
  case VesselColouring::order: return colour_by_order;
  case VesselColouring::diagnostic: break;
  }
  return palette_of_gl;
}

} // namespace

VesselFrame make_vessel_frame(const VesselScene& scene) {
  const glm::dmat4 clip_from_tree =
      glm::dmat4{scene.camera.view_projection} * glm::dmat4{scene.world_from_tree};
  const glm::dmat4 rows = glm::transpose(clip_from_tree);
  VesselFrame frame;
  frame.along = rows[3];
  frame.across = 0.5 * scene.width * (rows[0] + rows[3]);
  frame.up = 0.5 * scene.height * (rows[1] + rows[3]);
  // The rows of depth and distance differ by a factor and a constant.
  const glm::dvec3 direction{rows[3]};
  const double factor = glm::dot(glm::dvec3{rows[2]}, direction) / glm::dot(direction, direction);
  frame.depth_offset = static_cast<float>(factor);
  frame.depth_scale = static_cast<float>(rows[2].w - factor * rows[3].w);
  frame.pixels_per_unit = static_cast<double>(scene.pixels_per_unit());
  frame.near_mm = scene.camera.near_mm;
  frame.far_mm = scene.camera.far_mm;
  frame.width = static_cast<float>(scene.width);
  frame.height = static_cast<float>(scene.height);
  frame.middle_x =
      frame.width / 2 - scene.camera.centre_shift * static_cast<float>(frame.pixels_per_unit);
  frame.middle_y = frame.height / 2;
  frame.look = scene.look;
  return frame;
}

std::array<VesselColour, palette_size> vessel_palette() {
  std::array<VesselColour, palette_size> palette{};
  std::ranges::copy(branch_colours, palette.begin());
  std::ranges::copy(order_colours, palette.begin() + palette_of_orders);
  palette[palette_of_gl] = drawn_by_gl;
  palette[palette_of_processor] = drawn_by_processor;
  return palette;
}

PlacedCluster place_cluster(const VesselFrame& frame, const pipeline::VesselCluster& cluster,
                            std::uint32_t segments) {
  const auto row = [&](const glm::dvec4& of) {
    const auto& o = cluster.origin_mm;
    const auto& s = cluster.step_mm;
    return std::array{static_cast<float>(of.x * static_cast<double>(o[0]) +
                                         of.y * static_cast<double>(o[1]) +
                                         of.z * static_cast<double>(o[2]) + of.w),
                      static_cast<float>(of.x * static_cast<double>(s[0])),
                      static_cast<float>(of.y * static_cast<double>(s[1])),
                      static_cast<float>(of.z * static_cast<double>(s[2]))};
  };
  const double smallest = static_cast<double>(cluster.smallest_radius_mm) * frame.pixels_per_unit;
  return {row(frame.across),
          row(frame.up),
          row(frame.along),
          static_cast<float>(smallest),
          cluster.log2_radius_step,
          cluster.first_node,
          cluster.references,
          segments,
          colour_of(frame.look.colouring, cluster.branch)};
}

std::uint32_t expanded_colour(const VesselFrame& frame, const PlacedCluster& cluster,
                              pipeline::PackedNode node) {
  switch (frame.look.colouring) {
  case VesselColouring::branch: break;
  case VesselColouring::order: return palette_of_orders + node.order();
  case VesselColouring::diagnostic: return palette_of_processor;
  }
  return cluster.colour;
}

} // namespace octascope::ui
