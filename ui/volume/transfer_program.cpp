#include "ui/volume/transfer_program.h"

#include <string>

#include "embedded_shaders.h"
#include <fmt/format.h>

#include "ui/dither/dither_mask.h"
#include "ui/transfer/flow_uniforms.h"

namespace octascope::ui {

namespace {

constexpr std::string_view as_window = "#define TRANSFER_IS_WINDOW\n";
constexpr std::string_view as_table = "";
constexpr std::string_view with_flow = "#define WITH_FLOW\n";
constexpr std::string_view as_depth = "#define TRANSFER_BY_DEPTH\n";

hal::Result<gl::Program> build(const VolumeShader& shader, std::string_view variant) {
  const std::string fragment =
      fmt::format("#define TRANSFER_ROW_BITS {}\n#define TRANSFER_LAST {}\n"
                  "#define DITHER_SIZE {}\n{}{}{}{}{}{}{}{}",
                  TransferTexture::row_bits, TransferTable::entries - 1, dither_size, variant,
                  shader.defines, shader.flow == WithFlow::yes ? with_flow : std::string_view{},
                  shader.flow == WithFlow::yes ? shaders::flow_look_glsl : std::string_view{},
                  variant == as_depth ? shaders::depth_tint_glsl : std::string_view{},
                  shaders::transfer_glsl, shaders::stops_glsl, shader.fragment);
  return gl::Program::build(shader.name, shader.vertex, fragment);
}

gl::Texture make_dither_texture() {
  gl::Texture texture = gl::Texture::make();
  glBindTexture(GL_TEXTURE_2D, texture.name());
  glTexStorage2D(GL_TEXTURE_2D, 1, GL_R32F, dither_size, dither_size);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, dither_size, dither_size, GL_RED, GL_FLOAT,
                  dither_mask().data());
  return texture;
}

} // namespace

void set_depth_tint(const gl::Program& program, const DepthColours& depths) {
  const auto set = [&](const char* name, const std::array<float, 4>& cubic) {
    glUniform4fv(program.uniform(name), 1, cubic.data());
  };
  set("u_tint_red", depth_tint_cubics[0]);
  set("u_tint_green", depth_tint_cubics[1]);
  set("u_tint_blue", depth_tint_cubics[2]);
  const float scale = 1 / (depths.to - depths.from);
  glUniform2f(program.uniform("u_tint_place"), scale, -depths.from * scale);
}

void set_flow(const gl::Program& program, const FlowScene& flow) {
  constexpr GLint flow_unit = 6;
  set_flow_look(program);
  glUniform1f(program.uniform("u_flow_opacity"), flow.opacity);
  glUniform1i(program.uniform("u_flow"), flow_unit);
  glActiveTexture(GL_TEXTURE0 + flow_unit);
  glBindTexture(GL_TEXTURE_3D, flow.texture.name());
  glActiveTexture(GL_TEXTURE0);
}

hal::Result<TransferProgram> TransferProgram::create(const VolumeShader& shader) {
  HAL_TRY(auto window, build(shader, as_window));
  HAL_TRY(auto table, build(shader, as_table));
  HAL_TRY(auto by_depth, build(shader, as_depth));
  return TransferProgram{std::move(window), std::move(table), std::move(by_depth),
                         make_dither_texture()};
}

const gl::Program& TransferProgram::variant(const TransferTexture& transfer) const {
  return transfer.depths() ? by_depth_ : transfer.window() ? window_ : table_;
}

const gl::Program& TransferProgram::use(const TransferTexture& transfer,
                                        const FlowScene* flow) const {
  const gl::Program& program = variant(transfer);
  constexpr GLint dither_unit = 4;
  program.use();
  glUniform1i(program.uniform("u_levels"), 0);
  glUniform1i(program.uniform("u_dither_mask"), dither_unit);
  glActiveTexture(GL_TEXTURE0 + dither_unit);
  glBindTexture(GL_TEXTURE_2D, dither_.name());
  if (transfer.depths())
    set_depth_tint(program, *transfer.depths());
  if (flow != nullptr)
    set_flow(program, *flow);
  if (const auto& window = transfer.window()) {
    glUniform3f(program.uniform("u_window"), window->ramp.scale, window->ramp.offset,
                window->opacity);
  } else {
    glUniform1i(program.uniform("u_transfer"), 1);
    glActiveTexture(GL_TEXTURE1);
    glBindTexture(GL_TEXTURE_2D, transfer.name());
  }
  return program;
}

} // namespace octascope::ui
