// Draws parallel polygons through the volume, front to back; used by the plane stack and the slice
// stack.
#pragma once

#include <vector>

#include <glm/vec3.hpp>

#include "hal/result.h"
#include "ui/gl/objects.h"
#include "ui/view/plane_box.h"
#include "ui/volume/transfer_program.h"
#include "ui/volume/volume_technique.h"

namespace octascope::ui {

// Threads: as gl/objects.h. Allocates when it is made, never afterwards.
class PolygonStack {
public:
  static constexpr int most_polygons = 2048;

  static hal::Result<PolygonStack> create(WithFlow flow);

  void clear() { used_ = 0; }
  void add(const PlanePolygon& polygon); // behind the previous ones; ignored if there are too many

  struct Spacing {
    glm::vec3 normal; // of the polygons, away from the eye, a unit vector
    float mm;         // between polygons, along the normal
    bool dithered;    // samples are moved along the normal by up to half of `mm`
  };
  // Composites with the "under" operator.
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
