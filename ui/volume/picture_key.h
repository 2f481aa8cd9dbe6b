// Everything that a picture of the volume depends on. Pure.
#pragma once

#include <cstdint>

#include <glm/mat4x4.hpp>

#include "ui/layout/layout.h"
#include "ui/view/draw_quality.h"
#include "ui/volume/volume_technique.h"

namespace octascope::ui {

struct VolumePictureKey {
  std::uint64_t upload = 0;   // counts volumes
  std::uint64_t mesh = 0;     // counts iso-surfaces
  std::uint64_t transfer = 0; // counts transfer functions
  glm::mat4 view_projection{0};
  float window_offset_db = 0;
  float window_size_db = 0;
  float opacity = 0;
  Technique technique = Technique::rays;
  std::uint64_t vessels = 0; // version of their picture; 0: none
  float vessel_opacity = 1;
  CutAway cut_away{};
  bool flow = false; // its opacity follows from the view's
  float step_mm = 0;
  int width = 0;
  int height = 0;
  bool operator==(const VolumePictureKey&) const = default;
};

VolumePictureKey volume_picture_key(const VolumeScene& scene, const DrawQuality& quality,
                                    const Rect& rect);

// The pixels of the volume's picture, for that many display pixels.
int picture_pixels(const DrawQuality& quality, int display_pixels);

// The distance between samples; the quality gives their number on the longest edge of the box.
float step_mm(const DrawQuality& quality, const pipeline::VolumeGeometry& geometry);

} // namespace octascope::ui
