// From millimetres of the volume to the pixels of a flat picture. Pure.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "ui/layout/crop.h"
#include "ui/layout/layout.h"
#include "ui/layout/scan_field.h"
#include "ui/vessels/sections/vessel_sections.h"

namespace octascope::ui {

// Where the volume's extents across and down the picture lie in it. Pixels from the picture's top
// left corner; what the crop cuts away lies outside.
struct PicturePlace {
  int width = 0;
  int height = 0;
  glm::vec2 extents_mm{1};            // of the whole volume, across and down
  std::array<glm::vec2, 4> corners{}; // of those extents, in order around them, as ScanField's

  glm::vec2 pixels(glm::vec2 at_mm) const;
  float pixels_per_mm() const; // of both directions, on average

  bool operator==(const PicturePlace&) const = default;
};

// `picture` is that of a panel, which shows what the crop leaves.
PicturePlace place_in_panel(FlatPicture picture, const pipeline::VolumeGeometry& geometry,
                            const Crop& crop, const Rect& rect);
// The microscope's picture, which shows the volume from above.
PicturePlace place_in_field(const pipeline::VolumeGeometry& geometry, const ScanField& field,
                            const Rect& rect);

// A mark in pixels, as the vertex buffer has it.
struct PlacedMark {
  glm::vec3 from;
  glm::vec3 to;
  glm::vec2 radii;
  glm::vec2 shares;
  std::array<std::uint8_t, 4> colour;
};

// Replaces the content of `placed`. Returns what the marks may cover of the picture, in its pixels.
Rect place_marks(std::span<const VesselMark> marks, const PicturePlace& place, float line_px,
                 std::vector<PlacedMark>& placed);

} // namespace octascope::ui
