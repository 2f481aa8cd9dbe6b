// The view-aligned plane stack: n planes perpendicular to the view through the 3D texture.
#pragma once

#include <vector>

#include <glm/vec3.hpp>

#include "hal/result.h"
#include "ui/camera.h"
#include "ui/gl/objects.h"
#include "ui/gl/program.h"
#include "ui/view_state.h"
#include "ui/volume/plane_box.h"
#include "ui/volume/volume_texture.h"

namespace octascope::ui {

// Threads: as gl/objects.h. draw() allocates nothing.
class PlaneStack {
public:
  static hal::Result<PlaneStack> create();

  // Draws front to back with the "under" operator into the bound framebuffer and viewport, which
  // must have an alpha channel and be cleared to zero: premultiplied colour and opacity come out.
  void draw(const VolumeTexture& volume, const Camera& camera, const ViewState& view, int planes);

private:
  explicit PlaneStack(gl::Program program);
  int fill_vertices(const Camera& camera, const glm::vec3& half, const StackSpacing& spacing,
                    int planes);

  gl::Program program_;
  gl::VertexArray vertex_array_;
  gl::Buffer vertex_buffer_;
  std::vector<glm::vec3> vertices_;
  struct {
    GLint view_projection, eye, forward, extents, levels, window, opacity, steps, first_depth,
        spacing;
  } uniforms_;
};

} // namespace octascope::ui
