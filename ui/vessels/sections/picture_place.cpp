#include "ui/vessels/sections/picture_place.h"

#include <algorithm>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace octascope::ui {

namespace {

glm::vec2 size_of(const Rect& rect) {
  return {static_cast<float>(rect.width), static_cast<float>(rect.height)};
}

} // namespace

glm::vec2 PicturePlace::pixels(glm::vec2 at_mm) const {
  const glm::vec2 share = at_mm / extents_mm;
  return glm::mix(glm::mix(corners[0], corners[1], share.x),
                  glm::mix(corners[3], corners[2], share.x), share.y);
}

float PicturePlace::pixels_per_mm() const {
  return (glm::distance(corners[0], corners[1]) / extents_mm.x +
          glm::distance(corners[0], corners[3]) / extents_mm.y) /
         2;
}

PicturePlace place_in_panel(FlatPicture picture, const pipeline::VolumeGeometry& geometry,
                            const Crop& crop, const Rect& rect) {
  const Section& across = picture == FlatPicture::crossed ? crop.b : crop.a;
  const Section& down = picture == FlatPicture::from_above ? crop.b : crop.depth;
  const glm::vec2 from{across.from, down.from};
  const glm::vec2 lengths{across.length(), down.length()};
  const auto corner = [&](float across_share, float down_share) {
    return (glm::vec2{across_share, down_share} - from) / lengths * size_of(rect);
  };
  const double across_mm = picture == FlatPicture::crossed ? geometry.b_mm() : geometry.a_mm();
  const double down_mm = picture == FlatPicture::from_above ? geometry.b_mm() : geometry.depth_mm();
  return {rect.width,
          rect.height,
          {static_cast<float>(across_mm), static_cast<float>(down_mm)},
          {corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)}};
}

PicturePlace place_in_field(const pipeline::VolumeGeometry& geometry, const ScanField& field,
                            const Rect& rect) {
  PicturePlace place{rect.width,
                     rect.height,
                     {static_cast<float>(geometry.a_mm()), static_cast<float>(geometry.b_mm())},
                     {}};
  std::ranges::transform(field.corners, place.corners.begin(),
                         [&](const ScanField::Corner& corner) {
                           return glm::vec2{corner.x, corner.y} * size_of(rect);
                         });
  return place;
}

Rect place_marks(std::span<const VesselMark> marks, const PicturePlace& place, float line_px,
                 std::vector<PlacedMark>& placed) {
  placed.clear();
  const float scale = place.pixels_per_mm();
  const auto bits = [](float v) { return static_cast<std::uint8_t>(v * 255 + 0.5F); };
  const glm::vec2 size{place.width, place.height};
  glm::vec2 lower = size;
  glm::vec2 upper{0};
  for (const VesselMark& mark : marks) {
    const glm::vec2 from = place.pixels({mark.from_mm.x, mark.from_mm.y});
    const glm::vec2 to = place.pixels({mark.to_mm.x, mark.to_mm.y});
    const glm::vec2 radii = scale * glm::vec2{mark.from_radius_mm, mark.to_radius_mm};
    placed.push_back({glm::vec3{from, scale * mark.from_mm.z},
                      glm::vec3{to, scale * mark.to_mm.z},
                      radii,
                      {mark.from_share, mark.to_share},
                      {bits(mark.colour[0]), bits(mark.colour[1]), bits(mark.colour[2]), 255}});
    const float reach = std::max(radii.x, radii.y) + line_px / 2 + 1;
    lower = glm::min(lower, glm::min(from, to) - reach);
    upper = glm::max(upper, glm::max(from, to) + reach);
  }
  lower = glm::floor(glm::clamp(lower, glm::vec2{0}, size));
  upper = glm::ceil(glm::clamp(upper, lower, size));
  return {static_cast<int>(lower.x), static_cast<int>(lower.y), static_cast<int>(upper.x - lower.x),
          static_cast<int>(upper.y - lower.y)};
}

} // namespace octascope::ui
