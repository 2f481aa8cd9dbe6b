// The hatching of missing data, shared by all panels.
#pragma once

#include <string>
#include <string_view>

#include "embedded_shaders.h"
#include <GLES3/gl3.h>

#include "ui/layout/layout.h"

namespace octascope::ui {

// The fragment shader with the function hatch() inserted before its main program.
inline std::string with_hatch(std::string_view fragment_source) {
  return "precision highp float;\n" + std::string{shaders::hatch_glsl} +
         std::string{fragment_source};
}

// Sets the hatching's origin and pitch for a picture in `rect`: sixty stripes over the target's
// height.
inline void set_hatch(GLint uniform, const Rect& rect, int target_height) {
  glUniform3f(uniform, static_cast<float>(rect.x),
              static_cast<float>(target_height - rect.bottom()),
              static_cast<float>(target_height) / 60);
}

} // namespace octascope::ui
