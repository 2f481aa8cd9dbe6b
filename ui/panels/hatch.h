// The hatching of missing data and the mark of saturated data, the same in every panel.
#pragma once

#include <string>
#include <string_view>

#include "embedded_shaders.h"
#include <GLES3/gl3.h>

#include "ui/canvas/palette.h"
#include "ui/layout/layout.h"

namespace octascope::ui {

// The fragment shader with the function hatch() prepended.
inline std::string with_hatch(std::string_view fragment_source) {
  return "precision highp float;\n" + std::string{shaders::hatch_glsl} +
         std::string{fragment_source};
}

// The same for a picture with nothing to mark, as nearly all are: where the processor draws, to look for
// marks takes most of a flat picture's time.
inline std::string all_good(std::string_view fragment_source) {
  return "precision highp float;\n#define ALL_GOOD\n" + std::string{fragment_source};
}

// Sets the uniform for the origin and scale of the hatching of a picture in `rect`: sixty stripes
// over the target's height.
inline void set_hatch(GLint uniform, const Rect& rect, int target_height) {
  glUniform3f(uniform, static_cast<float>(rect.x),
              static_cast<float>(target_height - rect.bottom()),
              static_cast<float>(target_height) / 60);
}

// Of the picture's side along which a saturated B-scan is marked.
inline constexpr float mark_share = 0.04F;

inline void set_colour(GLint uniform, Colour colour) {
  glUniform3f(uniform, static_cast<float>(colour.r) / 255, static_cast<float>(colour.g) / 255,
              static_cast<float>(colour.b) / 255);
}

} // namespace octascope::ui
