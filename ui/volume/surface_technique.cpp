#include "ui/volume/surface_technique.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "embedded_shaders.h"
#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/type_ptr.hpp>

#include "pipeline/volume/level_scale.h"
#include "ui/ray_caster/ray_frame.h"
#include "ui/view/window.h"
#include "ui/volume/transfer_program.h"

namespace octascope::ui {

namespace {

// In the window: from where on tissue's colour becomes metal's, and where it has.
constexpr float metal_from = 0.99F;
constexpr float metal_to = 1.13F;

// By so many decibels of seeing through, the opacity of what covers is halved, face on.
constexpr float glass_halved_db = 4.8F;

hal::Result<gl::Program> build_surface(std::string_view flow) {
  return gl::Program::build("surface", shaders::surface_vert,
                            fmt::format("{}{}{}{}", flow, shaders::depth_tint_glsl,
                                        shaders::stops_glsl, shaders::surface_frag));
}

const void* offset(std::size_t bytes) {
  return reinterpret_cast<const void*>(bytes);
}

} // namespace

float surface_level(const ViewState& view) {
  constexpr float place = 0.25F; // in the window
  return pipeline::level_count(view.window_offset_db + place * view.window_size_db);
}

SurfaceTechnique::Drawn::Drawn(gl::Program of)
    : program{std::move(of)}, view_projection{program.uniform("u_view_projection")},
      eye{program.uniform("u_eye")}, forward{program.uniform("u_forward")},
      extents{program.uniform("u_extents")}, colour{program.uniform("u_colour")},
      metal{program.uniform("u_metal")}, ambient{program.uniform("u_ambient")},
      cue{program.uniform("u_cue")}, cue_loss{program.uniform("u_cue_loss")},
      cut_away{program.uniform("u_cut_away")}, glass{program.uniform("u_glass")} {}

hal::Result<> SurfaceTechnique::prepare_flow() {
  constexpr int samples = 32;
  if (with_flow_)
    return {};
  HAL_TRY(auto program,
          build_surface(fmt::format("#define WITH_FLOW\n#define FLOW_SAMPLES {}\nprecision highp "
                                    "sampler3D;\n{}",
                                    samples, shaders::flow_look_glsl)));
  with_flow_.emplace(std::move(program));
  return {};
}

hal::Result<std::unique_ptr<SurfaceTechnique>>
SurfaceTechnique::create(TransferSet transfers, pipeline::ThreadSetup threads) {
  HAL_TRY(auto program, build_surface({}));
  return std::unique_ptr<SurfaceTechnique>{
      new SurfaceTechnique{std::move(program), std::move(transfers), std::move(threads)}};
}

SurfaceTechnique::SurfaceTechnique(gl::Program program, TransferSet transfers,
                                   pipeline::ThreadSetup threads)
    : thread_{pipeline::blank_depth_bins, std::move(threads)}, transfers_{std::move(transfers)},
      plain_{std::move(program)}, vertex_array_{gl::VertexArray::make()},
      vertices_{gl::Buffer::make()}, indices_{gl::Buffer::make()} {
  using pipeline::IsoVertex;
  glBindVertexArray(vertex_array_.name());
  glBindBuffer(GL_ARRAY_BUFFER, vertices_.name());
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_.name());
  glEnableVertexAttribArray(0);
  glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(IsoVertex),
                        offset(offsetof(IsoVertex, position_mm)));
  glEnableVertexAttribArray(1);
  glVertexAttribPointer(1, 3, GL_SHORT, GL_TRUE, sizeof(IsoVertex),
                        offset(offsetof(IsoVertex, normal)));
  glEnableVertexAttribArray(2);
  glVertexAttribPointer(2, 1, GL_UNSIGNED_BYTE, GL_TRUE, sizeof(IsoVertex),
                        offset(offsetof(IsoVertex, brightest)));
  glEnableVertexAttribArray(3);
  glVertexAttribPointer(3, 1, GL_UNSIGNED_BYTE, GL_TRUE, sizeof(IsoVertex),
                        offset(offsetof(IsoVertex, cover)));
  glBindVertexArray(0);
}

void SurfaceTechnique::finish(const ViewState& view) {
  thread_.request(surface_level(view));
  thread_.wait();
}

std::uint64_t SurfaceTechnique::prepare(const ViewState& view) {
  thread_.request(surface_level(view));
  if (const pipeline::IsoMesh* mesh = thread_.take_newest()) {
    upload(*mesh);
    ++mesh_;
  }
  return mesh_;
}

void SurfaceTechnique::upload(const pipeline::IsoMesh& mesh) {
  const auto bytes_of = [](const auto& items) {
    return static_cast<GLsizeiptr>(items.size() * sizeof(items.front()));
  };
  glBindVertexArray(vertex_array_.name());
  glBindBuffer(GL_ARRAY_BUFFER, vertices_.name());
  glBufferData(GL_ARRAY_BUFFER, bytes_of(mesh.vertices), mesh.vertices.data(), GL_DYNAMIC_DRAW);
  glBufferData(GL_ELEMENT_ARRAY_BUFFER, bytes_of(mesh.corners), mesh.corners.data(),
               GL_DYNAMIC_DRAW);
  glBindVertexArray(0);
  corners_ = mesh.corners.size();
  covers_ = mesh.covers;
  extents_mm_ = {mesh.extents_mm[1], mesh.extents_mm[0], mesh.extents_mm[2]};
}

void SurfaceTechnique::set_uniforms(const Drawn& drawn, const VolumeScene& scene) const {
  const Camera& camera = scene.camera;
  const ColourMap& colours = transfers_.colours(scene.view);
  const auto set_colour = [](GLint uniform, const TransferTable::Colour& colour) {
    glUniform3f(uniform, colour.red, colour.green, colour.blue);
  };
  const float middle = camera.depth_of(glm::vec3{0});
  const float reach = glm::dot(glm::abs(camera.forward), extents_mm_ / 2.0F);
  const float near = std::max(middle - reach, camera.near_mm);
  glUniformMatrix4fv(drawn.view_projection, 1, GL_FALSE, glm::value_ptr(camera.view_projection));
  glUniform3fv(drawn.eye, 1, glm::value_ptr(camera.eye));
  glUniform3fv(drawn.forward, 1, glm::value_ptr(camera.forward));
  glUniform3fv(drawn.extents, 1, glm::value_ptr(extents_mm_));
  set_colour(drawn.colour, colours.at(surface_tissue));
  set_colour(drawn.metal, colours.at(surface_metal));
  glUniform1i(drawn.program.uniform("u_by_depth"), scene.transfer.depths() ? 1 : 0);
  if (scene.transfer.depths())
    set_depth_tint(drawn.program, *scene.transfer.depths());
  glUniform1f(drawn.ambient, surface_ambient);
  glUniform2f(drawn.cue, near, 1 / (middle + reach - near));
  glUniform1f(drawn.cue_loss, depth_cue);
  const CutAway& away = scene.cut_away;
  glUniform4f(drawn.cut_away, away.from.x, away.from.y, away.to.x, away.to.y);
  const WindowRamp window = window_ramp(scene.view);
  glUniform2f(drawn.program.uniform("u_window"), window.scale, window.offset);
  glUniform2f(drawn.program.uniform("u_metallic"), metal_from, metal_to);
  glUniform1f(drawn.program.uniform("u_halvings"), scene.view.see_through_db / glass_halved_db);
}

void SurfaceTechnique::draw_mesh(const Drawn& drawn, bool glass) const {
  glUniform1i(drawn.glass, glass ? 1 : 0);
  glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(corners_), GL_UNSIGNED_INT, nullptr);
}

void SurfaceTechnique::do_draw(const VolumeScene& scene) {
  prepare(scene.view);
  if (corners_ == 0)
    return;
  const Drawn& drawn = scene.flow != nullptr ? *with_flow_ : plain_;
  drawn.program.use();
  set_uniforms(drawn, scene);
  if (scene.flow != nullptr) {
    set_flow(drawn.program, *scene.flow);
    glUniform1f(drawn.program.uniform("u_flow_reach"), surface_flow_mm / extents_mm_.y);
  }
  set_depth_mask(drawn.program, scene.vessels, scene.camera);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  glDepthMask(GL_TRUE);
  glClearDepthf(1);
  glClear(GL_DEPTH_BUFFER_BIT);
  glBindVertexArray(vertex_array_.name());
  draw_mesh(drawn, false);
  if (covers_ && scene.view.see_through_db > 0) { // over the rest, and no depth of its own
    constexpr GLenum colour = GL_COLOR_ATTACHMENT0;
    glDrawBuffers(1, &colour);
    glDepthMask(GL_FALSE);
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    draw_mesh(drawn, true);
    glDisable(GL_BLEND);
    glDepthMask(GL_TRUE);
  }
  glBindVertexArray(0);
  glDisable(GL_DEPTH_TEST);
}

} // namespace octascope::ui
