// What a surface's corners look like, beside where they are: as bright as what is at hand, and of a cover
// or not. Found in the volume that the surface was taken from, so that both are of the same moment.
#pragma once

#include <cstdint>
#include <vector>

#include "pipeline/surface/iso_surface.h"
#include "pipeline/volume/cover.h"

namespace octascope::pipeline {

// Threads: one. Allocates as the grid grows.
class IsoLook {
public:
  // Keeps the grid's levels, as they are now.
  void keep(const IsoGrid& grid);
  // Tells each corner of a mesh of that grid, the brightest of the levels kept.
  void tell(const IsoGrid& grid, const Cover& cover, IsoMesh& mesh) const;

private:
  std::uint8_t brightest_at(const IsoGrid& grid, const IsoVertex& vertex) const;

  std::vector<std::uint8_t> levels_; // as the grid's, whole counts
};

} // namespace octascope::pipeline
