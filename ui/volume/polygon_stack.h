// Draws parallel polygons through the volume, front to back: what plane stack and slice stack
// share.
#pragma once

#include <vector>

#include <glm/vec3.hpp>

#include "hal/result.h"
#include "ui/gl/objects.h"
#include "ui/view/plane_box.h"
#include "ui/volume/transfer_program.h"
#include "ui/volume/volume_technique.h"

namespace octascope::ui {

// Threads: as gl/objects.h. Allocates only when made.
class PolygonStack {
public:
  static constexpr int most_polygons = 2048;

  static hal::Result<PolygonStack> create();

  void clear() { used_ = 0; }
  void add(const PlanePolygon& polygon); // behind those before it; ignored if there are too many

  struct Spacing {
    glm::vec3 normal; // of the polygons, away from the eye, a unit vector
    float mm;         // from one to the next along it
    bool dithered;    // samples lie up to half of it before or behind the polygon
  };
  // With the "under" operator.
  void draw(const VolumeScene& scene, const Spacing& spacing);

private:
  explicit PolygonStack(TransferProgram program);

  TransferProgram program_;
  gl::VertexArray vertex_array_;
  gl::Buffer vertex_buffer_;
  std::vector<glm::vec3> vertices_;
  std::size_t used_ = 0;
};

} // namespace octascope::ui
