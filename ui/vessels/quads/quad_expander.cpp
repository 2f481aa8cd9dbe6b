#include "ui/vessels/quads/quad_expander.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace octascope::ui {

namespace {

constexpr float padding = 1.0F / 64; // as shaders/vessels/vessel_quad.glsl

// Of pixel centres between two places: none?
bool none_between(float lower, float upper) {
  return std::floor(upper - 0.5F + padding) < std::ceil(lower - 0.5F - padding);
}

bool may_cover_a_pixel(const VesselFrame& frame, const SegmentOutline& o) {
  const float end_radius = o.radius + o.radius_change;
  const float end_x = o.start_x + o.ahead_x;
  const float end_y = o.start_y + o.ahead_y;
  const float left = std::min(o.start_x - o.radius, end_x - end_radius);
  const float right = std::max(o.start_x + o.radius, end_x + end_radius);
  const float bottom = std::min(o.start_y - o.radius, end_y - end_radius);
  const float top = std::max(o.start_y + o.radius, end_y + end_radius);
  return right > 0 && left < frame.width && top > 0 && bottom < frame.height &&
         !none_between(left, right) && !none_between(bottom, top);
}

} // namespace

std::uint32_t expand_quads(const VesselFrame& frame, const PlacedCluster& cluster,
                           std::span<const pipeline::PackedNode> nodes, QuadVertex* to) {
  const std::uint32_t count = cluster.references + cluster.segments;
  const auto packed = nodes.subspan(cluster.first_node);
  std::array<PlacedNode, pipeline::largest_cluster> placed;
  for (std::uint32_t i = 0; i < count; ++i)
    placed[i] = place_node(cluster, packed[i]);
  QuadVertex* const begin = to;
  for (std::uint32_t i = cluster.references; i < count; ++i) {
    const pipeline::PackedNode node = packed[i];
    // The parent may come after those that are drawn.
    const PlacedNode parent =
        node.parent() < count ? placed[node.parent()] : place_node(cluster, packed[node.parent()]);
    QuadVertex vertex;
    if (!project_segment(parent, placed[i], frame.near_mm, least_radius_px(node.order()),
                         vertex.outline) ||
        !may_cover_a_pixel(frame, vertex.outline))
      continue;
    vertex.colour = expanded_colour(frame, cluster, node);
    to = std::fill_n(to, quad_vertices, vertex);
  }
  return static_cast<std::uint32_t>((to - begin) / quad_vertices);
}

} // namespace octascope::ui
