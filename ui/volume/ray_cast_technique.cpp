#include "ui/volume/ray_cast_technique.h"

#include <array>

#include "embedded_shaders.h"
#include <glm/geometric.hpp>
#include <glm/gtc/type_ptr.hpp>

#include "ui/ray_caster/ray_frame.h"
#include "ui/ray_caster/ray_geometry.h"
#include "ui/view/plane_box.h"

namespace octascope::ui {

namespace {

constexpr GLint brick_unit = 2;
constexpr GLint light_unit = 5;

VolumeShader shader_of(RayMode mode, WithFlow flow) {
  const auto ray_cast = [flow](std::string_view name, std::string_view defines) {
    return VolumeShader{name, shaders::picture_vert, shaders::ray_cast_frag, defines, flow};
  };
  switch (mode) {
  case RayMode::composite: break;
  case RayMode::shaded: return ray_cast("ray_cast, shaded", "#define RAY_SHADED\n");
  case RayMode::maximum: return ray_cast("ray_cast, maximum", "#define RAY_MAXIMUM\n");
  }
  return ray_cast("ray_cast", "");
}

void set(const gl::Program& program, const char* name, const glm::vec3& value) {
  glUniform3fv(program.uniform(name), 1, glm::value_ptr(value));
}
void set(const gl::Program& program, const char* name, float value) {
  glUniform1f(program.uniform(name), value);
}

} // namespace

hal::Result<RayCastTechnique> RayCastTechnique::create(RayMode mode, WithFlow flow) {
  HAL_TRY(auto program, TransferProgram::create(shader_of(mode, flow)));
  return RayCastTechnique{mode, std::move(program)};
}

RayCastTechnique::RayCastTechnique(RayMode mode, TransferProgram program)
    : mode_{mode}, program_{std::move(program)}, vertex_array_{gl::VertexArray::make()} {}

void RayCastTechnique::prepare_bricks(const VolumeScene& scene) {
  const BrickSource source{scene.upload, scene.transfer.version()};
  if (brick_source_ == source)
    return;
  const bool maximum = mode_ == RayMode::maximum; // that of flow is looked for on its own
  if (scene.flow != nullptr && !maximum)
    flow_bricks_.update_flow(scene.flow->marks, false, scene.team);
  bricks_.update(*scene.occupancy, scene.transfer.visible(),
                 maximum ? Visibility::maximum : Visibility::range, scene.team, {},
                 scene.flow != nullptr && !maximum ? &flow_bricks_ : nullptr);
  distances_.measure(bricks_, scene.team);
  const pipeline::BrickCounts& n = bricks_.counts();
  glActiveTexture(GL_TEXTURE0 + brick_unit);
  if (!brick_texture_ || n != brick_counts_) {
    brick_texture_ = gl::Texture::make();
    glBindTexture(GL_TEXTURE_3D, brick_texture_.name());
    glTexStorage3D(GL_TEXTURE_3D, 1, GL_R16UI, n.depth, n.a, n.b);
    glTexParameteri(GL_TEXTURE_3D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_3D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    brick_counts_ = n;
  }
  glBindTexture(GL_TEXTURE_3D, brick_texture_.name());
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTexSubImage3D(GL_TEXTURE_3D, 0, 0, 0, 0, n.depth, n.a, n.b, GL_RED_INTEGER, GL_UNSIGNED_SHORT,
                  distances_.data());
  brick_source_ = source;
}

void RayCastTechnique::set_rays(const gl::Program& program, const VolumeScene& scene) const {
  const Camera& camera = scene.camera;
  const pipeline::VolumeGeometry& g = scene.volume.geometry();
  const RayGeometry rays = ray_geometry(g, camera, scene.cut_away);
  set(program, "u_lower", rays.lower);
  set(program, "u_upper", rays.upper);
  glUniform1i(program.uniform("u_is_cut"), rays.is_cut ? 1 : 0);
  glUniform2fv(program.uniform("u_cut"), 1, glm::value_ptr(rays.cut));
  set(program, "u_eye", rays.eye);
  set(program, "u_forward", rays.forward);
  set(program, "u_right", rays.right);
  set(program, "u_up", rays.up);
  const glm::vec3 scale = 1.0F / glm::vec3{g.depths, g.a_scans, g.b_scans};
  set(program, "u_to_texture_scale", scale);
  set(program, "u_to_texture_offset", glm::vec3{0.5F, -0.5F, -0.5F} * scale);

  std::array<GLint, 4> viewport{};
  glGetIntegerv(GL_VIEWPORT, viewport.data());
  const auto at = [&](std::size_t i) { return static_cast<float>(viewport[i]); };
  glUniform4f(program.uniform("u_viewport"), at(0), at(1), at(2), at(3));
  glUniform2f(program.uniform("u_pixel_size"), 2 * camera.tan_half_height * camera.aspect / at(2),
              2 * camera.tan_half_height / at(3));
  glUniform1f(program.uniform("u_centre_shift"), camera.centre_shift);
  set(program, "u_near_mm", camera.near_mm);
  set(program, "u_step_mm", scene.step_mm);
  set(program, "u_steps", scene.step_mm / reference_step_mm(box_extents_mm(g) / 2.0F));
  set(program, "u_opaque_transparency", opaque_transparency);
  set(program, "u_no_depth", no_depth);
}

void RayCastTechnique::upload_light(const LightVolume& light) {
  const LightVolume::Counts& n = light.counts();
  glActiveTexture(GL_TEXTURE0 + light_unit);
  if (!light_texture_ || n != light_counts_) {
    light_texture_ = gl::Texture::make();
    light_counts_ = n;
    light_version_ = 0;
    glBindTexture(GL_TEXTURE_3D, light_texture_.name());
    glTexStorage3D(GL_TEXTURE_3D, 1, GL_RGBA8, n.depth, n.a, n.b);
    glTexParameteri(GL_TEXTURE_3D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_3D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_3D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_3D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_3D, GL_TEXTURE_WRAP_R, GL_CLAMP_TO_EDGE);
  }
  glBindTexture(GL_TEXTURE_3D, light_texture_.name());
  if (light_version_ == light.version())
    return;
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  glTexSubImage3D(GL_TEXTURE_3D, 0, 0, 0, 0, n.depth, n.a, n.b, GL_RGBA, GL_UNSIGNED_BYTE,
                  light.texels().data());
  light_version_ = light.version();
}

void RayCastTechnique::set_light(const gl::Program& program, const VolumeScene& scene) {
  const RayGeometry rays = ray_geometry(scene.volume.geometry(), scene.camera, scene.cut_away);
  glUniform1i(program.uniform("u_lit"), scene.light != nullptr ? 1 : 0);
  glUniform1i(program.uniform("u_light"), light_unit);
  if (scene.light != nullptr) {
    upload_light(*scene.light);
    const LightVolume::Counts& n = scene.light->counts();
    const glm::vec3 share = 1.0F / glm::vec3{n.depth, n.a, n.b};
    set(program, "u_to_light_scale", scene.light->texel_scale() * share);
    set(program, "u_to_light_offset", (scene.light->texel_offset() + 0.5F) * share);
  }
  set(program, "u_lamp", rays.lamp);
  set(program, "u_mm", rays.mm);
  set(program, "u_least_power", least_power);
  set(program, "u_ambient", ambient_light);
  set(program, "u_level_light", level_light);
  set(program, "u_weak_slope", weak_slope);
  set(program, "u_open_light", open_light);
  set(program, "u_least_open", least_open);
  glUniform2f(program.uniform("u_gleam"), gleam_from, gleam_to);
  set(program, "u_cue_near_mm", rays.cue_near_mm);
  set(program, "u_cue_per_mm", rays.cue_per_mm);
  set(program, "u_depth_cue", depth_cue);
}

void RayCastTechnique::do_draw(const VolumeScene& scene) {
  const bool leap = scene.occupancy != nullptr;
  if (leap)
    prepare_bricks(scene);
  const gl::Program& program = program_.use(scene.transfer, scene.flow);
  set_rays(program, scene);
  set_depth_mask(program, scene.vessels, scene.camera);
  if (mode_ == RayMode::shaded)
    set_light(program, scene);
  glUniform1i(program.uniform("u_leap"), leap ? 1 : 0);
  glUniform3i(program.uniform("u_brick_shift"), pipeline::brick_depth_shift,
              pipeline::brick_a_shift, pipeline::brick_b_shift);
  glUniform1i(program.uniform("u_bricks"), brick_unit);
  glActiveTexture(GL_TEXTURE0 + brick_unit);
  glBindTexture(GL_TEXTURE_3D, leap ? brick_texture_.name() : 0);
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_3D, scene.volume.name());
  glBindVertexArray(vertex_array_.name());
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glBindVertexArray(0);
}

} // namespace octascope::ui
