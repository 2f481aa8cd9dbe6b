#include "ui/vessels/quads/quad_programs.h"

#include "embedded_shaders.h"
#include <fmt/format.h>

#include "ui/vessels/scene/vessel_uniforms.h"

namespace octascope::ui {

namespace {

hal::Result<gl::Program> build(QuadKind kind, std::string_view name, std::string_view vertex_head,
                               std::string_view vertex_main) {
  const bool rounded = kind == QuadKind::round;
  const std::string vertex = fmt::format("{}{}{}{}", vessel_shader_head(), vertex_head,
                                         shaders::vessel_quad_glsl, vertex_main);
  const std::string fragment = fmt::format(
      "{}{}{}{}{}", vessel_shader_head(), rounded ? "#define ROUNDED\n" : "",
      shaders::vessel_light_glsl, rounded ? shaders::vessel_relief_glsl : std::string_view{},
      shaders::vessel_quad_frag);
  return gl::Program::build(name, vertex, fragment);
}

} // namespace

std::vector<std::uint16_t> quad_indices(int segments) {
  std::vector<std::uint16_t> indices;
  indices.reserve(static_cast<std::size_t>(segments * quad_corners));
  for (int first = 0; first < segments * quad_vertices; first += quad_vertices)
    for (const int corner : {0, 1, 2, 2, 1, 3})
      indices.push_back(static_cast<std::uint16_t>(first + corner));
  return indices;
}

hal::Result<QuadPrograms> QuadPrograms::create(std::string_view name, std::string_view vertex_head,
                                               std::string_view vertex_main) {
  HAL_TRY(auto thin, build(QuadKind::thin, name, vertex_head, vertex_main));
  HAL_TRY(auto round, build(QuadKind::round, name, vertex_head, vertex_main));
  return QuadPrograms{Programs{std::move(thin), std::move(round)}};
}

void QuadPrograms::begin(const VesselFrame& frame) const {
  for (const gl::Program& program : programs_)
    set_vessel_uniforms(program, frame);
}

} // namespace octascope::ui
