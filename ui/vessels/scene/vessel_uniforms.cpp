#include "ui/vessels/scene/vessel_uniforms.h"

#include <fmt/format.h>

namespace octascope::ui {

std::string vessel_shader_head() {
  return fmt::format(
      "precision highp float;\nprecision highp int;\n"
      "#define COLOUR_BY_ORDER {}u\n#define PALETTE_OF_ORDERS {}u\n"
      "#define PALETTE_SIZE {}\n"
      "#define LEAST_ORDER_KEPT_VISIBLE {}u\n#define LEAST_RADIUS {:f}\n"
      "#define LEAST_RELIEF {:f}\n#define CUT_RELIEF {:f}\n"
      "#define MEAN_OFF_AXIS {:f}\n#define LEAST_SHADED {:f}\n"
      "#define LEAST_RAISED {:f}\n#define STEEPEST_RISE {:f}\n#define RELIEF_RISE {:f}\n"
      "#define END_SET_BACK {:e}\n",
      colour_by_order, palette_of_orders, palette_size, least_order_kept_visible,
      least_vessel_radius_px, least_relief_px, cut_relief, mean_off_axis, least_shaded_px,
      least_raised_px, steepest_rise, relief_rise, end_set_back);
}

void set_vessel_uniforms(const gl::Program& program, const VesselFrame& frame) {
  static_assert(sizeof(VesselColour) == 3 * sizeof(float));
  const auto palette = vessel_palette();
  const VesselLook& look = frame.look;
  program.use();
  glUniform1i(program.uniform("u_nodes"), 0);
  glUniform2f(program.uniform("u_size"), frame.width, frame.height);
  glUniform2f(program.uniform("u_depth"), frame.depth_offset, frame.depth_scale);
  glUniform1f(program.uniform("u_near"), frame.near_mm);
  glUniform1f(program.uniform("u_widest_start"), pipeline::widest_start);
  glUniform3f(program.uniform("u_middle"), frame.middle_x, frame.middle_y,
              static_cast<float>(frame.pixels_per_unit));
  glUniform3fv(program.uniform("u_palette"), static_cast<GLsizei>(palette.size()),
               palette.front().data());
  glUniform1f(program.uniform("u_ambient"), vessel_ambient);
  glUniform3f(program.uniform("u_cue"), look.cue_near_mm, 1 / (look.cue_far_mm - look.cue_near_mm),
              look.depth_cue);
}

VesselDrawState::VesselDrawState() {
  glDisable(GL_BLEND);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  glDepthMask(GL_TRUE);
}

VesselDrawState::~VesselDrawState() {
  glBindVertexArray(0);
  glDisable(GL_CULL_FACE);
  glDisable(GL_DEPTH_TEST);
}

} // namespace octascope::ui
