// Fills a rectangle of the bound framebuffer with a fragment shader.
#pragma once

#include <string_view>

#include "hal/result.h"
#include "ui/gl/objects.h"
#include "ui/gl/program.h"
#include "ui/layout/layout.h"

namespace octascope::ui::gl {

// The fragment shader gets `v_unit`, 0…1 from the rectangle's top left corner.
//
// Threads: as gl/objects.h.
class PicturePass {
public:
  static hal::Result<PicturePass> create(std::string_view name, std::string_view fragment_source);

  // Makes the program current, so that its uniforms can be set before fill() draws.
  void use() const { program_.use(); }
  const Program& program() const { return program_; }
  GLint uniform(const char* name) const { return program_.uniform(name); }
  void fill(const Rect& rect, int target_height) const;

  // Makes the program current and blends `picture`, premultiplied, over the framebuffer. For
  // shaders with a sampler `u_picture`.
  void blend(const Texture& picture, const Rect& rect, int target_height) const;

private:
  explicit PicturePass(Program program)
      : program_{std::move(program)}, vertex_array_{VertexArray::make()} {}
  Program program_;
  VertexArray vertex_array_; // empty: vertices are computed from their index
};

} // namespace octascope::ui::gl
