#include "ui/vessels/tubes/tube_expander.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "ui/vessels/scene/segment_projection.h"
#include "ui/vessels/tubes/vessel_ends.h"

namespace octascope::ui {

namespace {

struct EyeNode {
  glm::vec3 place;
  float radius; // mm
};

EyeNode eye_node(const VesselFrame& frame, const PlacedNode& node) {
  const auto scale = static_cast<float>(frame.pixels_per_unit);
  return {{(node.across - frame.middle_x * node.along) / scale,
           (node.up - frame.middle_y * node.along) / scale, node.along},
          node.radius / scale};
}

// Across the axis and the line of sight; any side where the axis points at the eye.
glm::vec3 side_of(const glm::vec3& axis, const glm::vec3& place) {
  const glm::vec3 side = glm::cross(axis, place);
  const float size = glm::length(side);
  return size > 1e-4F * glm::length(place) ? side / size
                                           : glm::normalize(glm::cross(axis, {0, 1, 0.1F}));
}

bool may_be_seen(const VesselFrame& frame, const PlacedNode& a, const PlacedNode& b, float radius) {
  const auto reach =
      static_cast<float>(frame.pixels_per_unit) * radius * 1.1F / std::min(a.along, b.along) +
      0.05F;
  const float ax = a.across / a.along;
  const float ay = a.up / a.along;
  const float bx = b.across / b.along;
  const float by = b.up / b.along;
  const float left = std::min(ax, bx) - reach;
  const float right = std::max(ax, bx) + reach;
  const float bottom = std::min(ay, by) - reach;
  const float top = std::max(ay, by) + reach;
  const auto has_centre = [](float lower, float upper) {
    return std::ceil(lower - 0.5F) <= std::floor(upper - 0.5F);
  };
  return right > 0 && left < frame.width && top > 0 && bottom < frame.height &&
         has_centre(left, right) && has_centre(bottom, top);
}

} // namespace

struct TubeExpander::Tube {
  EyeNode start, end;
  glm::vec3 axis, side;
  // Of the first ring: the parent's, or the tube's own.
  glm::vec3 start_axis, start_side;
  bool joined = false;
  std::int16_t colour = 0;

  Tube(EyeNode from, EyeNode to) : start{from}, end{to} {
    const glm::vec3 along = end.place - start.place;
    const float size = glm::length(along);
    axis = size > 0 ? along / size : glm::vec3{1, 0, 0};
    side = side_of(axis, end.place);
    start_axis = axis;
    start_side = side_of(axis, start.place);
  }

  void join(const VesselFrame& frame, const EyeNode& before) {
    const glm::vec3 into = start.place - before.place;
    const float size = glm::length(into);
    if (size == 0)
      return;
    const float cosine = glm::dot(into, axis) / size;
    const float bend_px =
        (1 - cosine) * start.radius * static_cast<float>(frame.pixels_per_unit) / start.place.z;
    if (bend_px >= straight_px || cosine <= 0.5F)
      return;
    joined = true;
    start_axis = into / size;
    start_side = side_of(start_axis, start.place);
  }

  TubeVertex vertex(const EyeNode& middle, const glm::vec3& out) const {
    constexpr float scale = 32767;
    const auto component = [&](float c) { return static_cast<std::int16_t>(c * scale); };
    return {middle.place + middle.radius * out,
            {component(out.x), component(out.y), component(out.z)},
            colour};
  }
};

TubeExpander::TubeExpander(const TubeShape& shape) : shape_{shape} {
  constexpr float whole_turn = 2 * std::numbers::pi_v<float>;
  for (int i = 0; i < shape.sectors; ++i) {
    const float angle = whole_turn * static_cast<float>(i) / static_cast<float>(shape.sectors);
    turns_.emplace_back(std::cos(angle), std::sin(angle));
  }
  for (int i = 0; i <= shape.cap_rings(); ++i) {
    const float angle =
        whole_turn / 4 * static_cast<float>(i) / static_cast<float>(shape.cap_rings());
    rises_.emplace_back(std::cos(angle), std::sin(angle));
  }
}

glm::vec3 TubeExpander::around(const glm::vec3& axis, const glm::vec3& side, int sector) const {
  const int turns = shape_.sectors;
  const glm::vec2 turn = turns_[static_cast<std::size_t>((sector % turns + turns) % turns)];
  return turn.x * side + turn.y * glm::cross(axis, side);
}

void TubeExpander::add_body(const Tube& tube, TubeVertex* to) const {
  // The first ring may be turned against that of the end: begin with the sector that is nearest.
  const glm::vec3 other = glm::cross(tube.start_axis, tube.start_side);
  const float turn = std::atan2(glm::dot(tube.side, other), glm::dot(tube.side, tube.start_side));
  const int first = static_cast<int>(
      std::floor(turn * static_cast<float>(shape_.sectors) / (2 * std::numbers::pi_v<float>)+0.5F));
  for (int i = 0; i < shape_.sectors; ++i)
    *to++ = tube.vertex(tube.start, around(tube.start_axis, tube.start_side, i + first));
  for (int i = 0; i < shape_.sectors; ++i)
    *to++ = tube.vertex(tube.end, around(tube.axis, tube.side, i));
}

void TubeExpander::add_cap(const Tube& tube, bool at_end, TubeVertex* to) const {
  const EyeNode& middle = at_end ? tube.end : tube.start;
  const glm::vec3& side = at_end ? tube.side : tube.start_side;
  const int direction = at_end ? 1 : -1;
  for (const glm::vec2& rise : rises_)
    for (int i = 0; i < shape_.sectors; ++i)
      *to++ = tube.vertex(middle, rise.x * around(tube.axis, side, direction * i) +
                                      static_cast<float>(direction) * rise.y * tube.axis);
}

void TubeExpander::expand(const VesselFrame& frame, const PlacedCluster& cluster,
                          std::span<const pipeline::PackedNode> nodes,
                          std::span<const std::uint32_t> passed, bool with_caps, TubeVertex* bodies,
                          TubeVertex* caps, Counts& counts) const {
  const std::uint32_t count = cluster.references + cluster.segments;
  const auto packed = nodes.subspan(cluster.first_node);
  const auto body_size = static_cast<std::size_t>(shape_.body_vertices());
  const auto cap_size = static_cast<std::size_t>(shape_.cap_vertices());
  std::array<PlacedNode, pipeline::largest_cluster> placed;
  for (std::uint32_t i = 0; i < count; ++i)
    placed[i] = place_node(cluster, packed[i]);
  // Parents may come after those that are drawn.
  const auto placed_at = [&](std::uint32_t i) {
    return i < count ? placed[i] : place_node(cluster, packed[i]);
  };
  for (std::uint32_t i = cluster.references; i < count; ++i) {
    const std::uint32_t parent = packed[i].parent();
    const std::uint32_t before = packed[parent].parent();
    PlacedNode start = placed_at(parent);
    PlacedNode end = placed[i];
    const bool continues =
        before != parent && goes_on(start.radius, end.radius) && start.along >= frame.near_mm;
    const bool cut = end.along < frame.near_mm;
    if (!make_segment(start, end, frame.near_mm))
      continue;
    thicken(start, least_radius_px(packed[i].order()));
    thicken(end, least_radius_px(packed[i].order()));
    Tube tube{eye_node(frame, start), eye_node(frame, end)};
    if (!may_be_seen(frame, start, end, std::max(tube.start.radius, tube.end.radius)))
      continue;
    if (continues)
      tube.join(frame, eye_node(frame, placed_at(before)));
    tube.colour = static_cast<std::int16_t>(expanded_colour(frame, cluster, packed[i]));
    add_body(tube, bodies + body_size * counts.bodies++);
    if (!with_caps)
      continue;
    if (!tube.joined)
      add_cap(tube, false, caps + cap_size * counts.caps++);
    const std::uint32_t node = cluster.first_node + i;
    if (cut || (passed[node / 32] >> node % 32 & 1U) == 0)
      add_cap(tube, true, caps + cap_size * counts.caps++);
  }
}

} // namespace octascope::ui
