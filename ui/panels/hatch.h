// The hatching of missing data, the same in every panel.
#pragma once

#include <string>
#include <string_view>

#include "embedded_shaders.h"

namespace octascope::ui {

// The fragment shader with the function hatch() before its main program.
inline std::string with_hatch(std::string_view fragment_source) {
  return "precision highp float;\n" + std::string{shaders::hatch_glsl} +
         std::string{fragment_source};
}

// Pixels between two stripes on a target of that height.
inline float hatch_pitch(int target_height) {
  return static_cast<float>(target_height) / 60;
}

} // namespace octascope::ui
