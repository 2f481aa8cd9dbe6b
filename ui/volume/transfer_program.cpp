#include "ui/volume/transfer_program.h"

#include <string>

#include "embedded_shaders.h"
#include <fmt/format.h>

namespace octascope::ui {

namespace {

hal::Result<gl::Program> build(const VolumeShader& shader, bool window) {
  const std::string fragment =
      fmt::format("#define TRANSFER_ROW_BITS {}\n#define TRANSFER_LAST {}\n{}{}{}{}{}",
                  TransferTexture::row_bits, TransferTable::entries - 1,
                  window ? "#define TRANSFER_IS_WINDOW\n" : "", shader.defines,
                  shaders::transfer_glsl, shaders::stops_glsl, shader.fragment);
  return gl::Program::build(shader.name, shader.vertex, fragment);
}

} // namespace

hal::Result<TransferProgram> TransferProgram::create(const VolumeShader& shader) {
  HAL_TRY(auto window, build(shader, true));
  HAL_TRY(auto table, build(shader, false));
  return TransferProgram{std::move(window), std::move(table)};
}

const gl::Program& TransferProgram::use(const TransferTexture& transfer) const {
  const gl::Program& program = transfer.window() ? window_ : table_;
  program.use();
  glUniform1i(program.uniform("u_levels"), 0);
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
