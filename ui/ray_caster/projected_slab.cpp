#include "ui/ray_caster/projected_slab.h"

#include <algorithm>
#include <cmath>

namespace octascope::ui {

namespace {

constexpr float spare_px = 1;
constexpr float spare_b_scans = 0.1F; // for positions that are rounded

// Of the turn from a to b to c: above 0 on one side of the line, below on the other.
float turn(const glm::vec2& a, const glm::vec2& b, const glm::vec2& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

bool before(const glm::vec2& a, const glm::vec2& b) {
  return a.x < b.x || (a.x == b.x && a.y < b.y);
}

} // namespace

// The hull of the corners. Source: A. M. Andrew, "Another efficient algorithm for convex hulls in two
// dimensions", Information Processing Letters 9 (1979).
ProjectedSlab::ProjectedSlab(const std::array<glm::vec2, 8>& corners) {
  std::array<glm::vec2, 8> sorted = corners;
  std::ranges::sort(sorted, before);
  std::array<glm::vec2, 17> hull{};
  std::size_t count = 0;
  const auto add = [&](const glm::vec2& point, std::size_t least) {
    while (count >= least && turn(hull[count - 2], hull[count - 1], point) <= 0)
      --count;
    hull[count++] = point;
  };
  for (const glm::vec2& point : sorted)
    add(point, 2);
  const std::size_t lower = count + 1;
  for (std::size_t i = sorted.size() - 1; i-- > 0;)
    add(sorted[i], lower);
  count_ = std::min(count - 1, outline_.size() - 1);
  std::copy_n(hull.begin(), count_ + 1, outline_.begin());
  const auto [left, right] = std::ranges::minmax(corners, {}, &glm::vec2::x);
  const auto [top, bottom] = std::ranges::minmax(corners, {}, &glm::vec2::y);
  const auto floor = [](float v) { return static_cast<int>(std::floor(v - spare_px)); };
  const auto ceil = [](float v) { return static_cast<int>(std::ceil(v + spare_px)); };
  bounds_ = {floor(left.x), floor(top.y), ceil(right.x) - floor(left.x),
             ceil(bottom.y) - floor(top.y)};
}

// Two convex shapes are apart where a side of one of them has the whole other one outside.
bool ProjectedSlab::may_meet(const Rect& rect) const {
  if (rect.x >= bounds_.right() || rect.right() <= bounds_.x || rect.y >= bounds_.bottom() ||
      rect.bottom() <= bounds_.y)
    return false;
  const float left = static_cast<float>(rect.x) - spare_px;
  const float right = static_cast<float>(rect.right()) + spare_px;
  const float top = static_cast<float>(rect.y) - spare_px;
  const float bottom = static_cast<float>(rect.bottom()) + spare_px;
  const std::array<glm::vec2, 4> corners{glm::vec2{left, top}, glm::vec2{right, top},
                                         glm::vec2{left, bottom}, glm::vec2{right, bottom}};
  for (std::size_t i = 0; i < count_; ++i)
    if (std::ranges::all_of(corners, [&](const glm::vec2& corner) {
          return turn(outline_[i], outline_[i + 1], corner) < 0;
        }))
      return false;
  return true;
}

std::optional<ProjectedSlab> project_slab(const pipeline::VolumeGeometry& geometry,
                                          const pipeline::BScanRange& b_scans, const Camera& camera,
                                          int width, int height) {
  const glm::vec3 extents = box_extents_mm(geometry);
  const auto along = [&](float b) { // the middle of B-scan 0 is at 0.5
    const float share = b / static_cast<float>(geometry.b_scans);
    return (std::clamp(share, 0.0F, 1.0F) - 0.5F) * extents.z;
  };
  // As far as the middles of their neighbours.
  const float from = along(static_cast<float>(b_scans.from) - 0.5F - spare_b_scans);
  const float to = along(static_cast<float>(b_scans.to) + 0.5F + spare_b_scans);
  std::array<glm::vec2, 8> corners;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const glm::vec3 at{((i & 1U) != 0 ? 0.5F : -0.5F) * extents.x,
                       ((i & 2U) != 0 ? 0.5F : -0.5F) * extents.y, (i & 4U) != 0 ? to : from};
    if (camera.depth_of(at) <= camera.near_mm)
      return std::nullopt;
    const glm::vec2 place = camera.project(at);
    corners[i] = {static_cast<float>(width) / 2 +
                      place.x * static_cast<float>(width) / camera.aspect,
                  static_cast<float>(height) * (0.5F + place.y)};
  }
  return ProjectedSlab{corners};
}

} // namespace octascope::ui
