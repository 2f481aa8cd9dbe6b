#include "ui/vessels/tubes/tube_shape.h"

#include "embedded_shaders.h"
#include <fmt/format.h>

#include "ui/vessels/scene/vessel_uniforms.h"

namespace octascope::ui {

namespace {

int band_corners(const TubeShape& shape) {
  return 2 * (shape.sectors + 1) + 2; // and a triangle or two without area to the next
}

// Between two rings of which the vertices stand one after the other.
void add_band(const TubeShape& shape, int ring, int next_ring, std::vector<std::uint32_t>& to) {
  const auto vertex = [&](int first, int sector) {
    return static_cast<std::uint32_t>(first + sector % shape.sectors);
  };
  to.push_back(vertex(next_ring, 0)); // repeated: no area
  for (int sector = 0; sector <= shape.sectors; ++sector) {
    to.push_back(vertex(next_ring, sector));
    to.push_back(vertex(ring, sector));
  }
  to.push_back(vertex(ring, shape.sectors));
}

} // namespace

int tube_body_corners(const TubeShape& shape) {
  return band_corners(shape);
}

int tube_cap_corners(const TubeShape& shape) {
  return shape.cap_rings() * band_corners(shape);
}

std::vector<std::uint32_t> tube_body_indices(const TubeShape& shape, int segments) {
  std::vector<std::uint32_t> indices;
  indices.reserve(static_cast<std::size_t>(segments * tube_body_corners(shape)));
  for (int i = 0; i < segments; ++i) {
    const int first = i * shape.body_vertices();
    add_band(shape, first, first + shape.sectors, indices);
  }
  return indices;
}

std::vector<std::uint32_t> tube_cap_indices(const TubeShape& shape, int caps) {
  std::vector<std::uint32_t> indices;
  indices.reserve(static_cast<std::size_t>(caps * tube_cap_corners(shape)));
  for (int i = 0; i < caps; ++i)
    for (int ring = 0; ring < shape.cap_rings(); ++ring) {
      const int first = i * shape.cap_vertices() + ring * shape.sectors;
      add_band(shape, first, first + shape.sectors, indices);
    }
  return indices;
}

hal::Result<gl::Program> build_tube_program(std::string_view name, std::string_view defines,
                                            std::string_view vertex_head,
                                            std::string_view vertex_main) {
  const std::string vertex = fmt::format("{}{}{}{}{}", vessel_shader_head(), defines, vertex_head,
                                         shaders::vessel_tube_glsl, vertex_main);
  const std::string fragment = fmt::format("{}{}{}", vessel_shader_head(),
                                           shaders::vessel_light_glsl, shaders::vessel_tube_frag);
  return gl::Program::build(name, vertex, fragment);
}

} // namespace octascope::ui
