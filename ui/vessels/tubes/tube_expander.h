// Segments as tubes, expanded by the processor.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "ui/vessels/tubes/tube_shape.h"

namespace octascope::ui {

// In the eye's frame, in mm: right, up and along the view.
struct TubeVertex {
  glm::vec3 place;
  std::array<std::int16_t, 3> normal; // of any length
  std::int16_t colour;                // index in the palette
};
static_assert(sizeof(TubeVertex) == 20);

// Computes the same as shaders/vessels/vessel_tube_nodes.vert. Each thread needs its own expander.
class TubeExpander {
public:
  explicit TubeExpander(const TubeShape& shape);

  struct Counts {
    std::uint32_t bodies = 0;
    std::uint32_t caps = 0;
  };

  // Appends a cluster's segments that may be in the picture: body_vertices() for each after the
  // counts.bodies already there, cap_vertices() for each half ball after counts.caps. `passed` are
  // the tree's passed_nodes(). There must be room for one body and two half balls per segment.
  void expand(const VesselFrame& frame, const PlacedCluster& cluster,
              std::span<const pipeline::PackedNode> nodes, std::span<const std::uint32_t> passed,
              bool with_caps, TubeVertex* bodies, TubeVertex* caps, Counts& counts) const;

private:
  struct Tube;

  void add_body(const Tube& tube, TubeVertex* to) const;
  void add_cap(const Tube& tube, bool at_end, TubeVertex* to) const;
  // The direction away from the axis at a sector's edge, counted from `side`.
  glm::vec3 around(const glm::vec3& axis, const glm::vec3& side, int sector) const;

  TubeShape shape_;
  std::vector<glm::vec2> turns_; // cosine and sine, per sector
  std::vector<glm::vec2> rises_; // of half balls, per ring
};

} // namespace octascope::ui
