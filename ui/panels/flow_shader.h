// What shaders of the flat pictures need to show what flows.
#pragma once

#include <string>
#include <string_view>

#include "embedded_shaders.h"
#include <GLES3/gl3.h>

#include "ui/transfer/depth_colours.h"
#include "ui/transfer/flow_uniforms.h"

namespace octascope::ui {

// The fragment shader with what flow looks like prepended, and the word that it is wanted.
inline std::string flowing(std::string_view fragment_source) {
  return "precision highp float;\n#define FLOW\n" + std::string{shaders::flow_look_glsl} +
         std::string{fragment_source};
}

// The same for one that shows it from above, coloured by its depth below the surface.
inline std::string seen_from_above(std::string_view fragment_source) {
  return flowing(std::string{shaders::depth_tint_glsl} +
                 std::string{shaders::flow_from_above_glsl} + std::string{fragment_source});
}

// Sets once what never changes of that, and leaves the program current. How deep the hues reach
// (u_tint_place) is of each picture.
inline void set_flow_from_above(const gl::Program& program) {
  program.use();
  set_flow_look(program);
  glUniform4fv(program.uniform("u_tint_red"), 1, depth_tint_cubics[0].data());
  glUniform4fv(program.uniform("u_tint_green"), 1, depth_tint_cubics[1].data());
  glUniform4fv(program.uniform("u_tint_blue"), 1, depth_tint_cubics[2].data());
}

} // namespace octascope::ui
