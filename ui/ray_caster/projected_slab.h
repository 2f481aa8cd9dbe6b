// Which pixels' rays may meet some B-scans of a volume. Pure.
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include <glm/vec2.hpp>

#include "pipeline/volume/volume.h"
#include "ui/layout/layout.h"
#include "ui/view/camera.h"

namespace octascope::ui {

// The outline of a slab of a volume's box in a picture: a convex polygon, in pixels from the upper
// left. Allocates nothing.
class ProjectedSlab {
public:
  // Of its corners, in any order.
  explicit ProjectedSlab(const std::array<glm::vec2, 8>& corners);

  // False only if no pixel of the rectangle lies in the polygon.
  bool may_meet(const Rect& rect) const;
  const Rect& bounds() const { return bounds_; }

private:
  std::array<glm::vec2, 9> outline_{}; // the first `count_`, then the first again
  std::size_t count_ = 0;
  Rect bounds_;
};

// Everything whose samples are interpolated from one of these B-scans, with a pixel to spare. The
// camera must be the volume's, the picture `width` x `height` pixels. Empty: it reaches behind the
// eye.
std::optional<ProjectedSlab> project_slab(const pipeline::VolumeGeometry& geometry,
                                          const pipeline::BScanRange& b_scans, const Camera& camera,
                                          int width, int height);

} // namespace octascope::ui
