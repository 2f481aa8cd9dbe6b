// Surfaces of equal level, as triangles.
//
// Source: marching cubes (pipeline/surface/cube_triangles.h). Corners lie on the grid's edges,
// where the interpolated level is the surface's; each is made once and shared. Normals are the
// gradient of the level there.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "pipeline/surface/iso_grid.h"
#include "pipeline/volume/occupancy.h"

namespace octascope::pipeline {

// Axes in the order depth, fast, slow.
struct IsoVertex {
  std::array<float, 3> position_mm;   // from the volume's corner
  std::array<std::int16_t, 3> normal; // ·32767; points to where the level falls
  // Told by IsoLook, else 0.
  std::uint8_t brightest; // level at hand
  std::uint8_t cover;     // ·255: the share of a cover's lowering
};

struct IsoMesh {
  std::vector<IsoVertex> vertices;
  std::vector<std::uint32_t> corners; // three a triangle, counter-clockwise seen from outside in
                                      // a right-handed (depth, fast, slow)
  std::array<float, 3> extents_mm{};  // of the volume
  bool covers = false;                // some of it may be a cover's (told by IsoLook)
  std::uint64_t of = 0;               // the volume's number (IsoSurfaceThread)

  std::size_t triangles() const { return corners.size() / 3; }
  void clear() {
    vertices.clear();
    corners.clear();
  }
};

// Allocates as the grid and the mesh grow.
class IsoExtractor {
public:
  // The surface between what is below `level` (a count, 0 to 255) and what is not. Open at the
  // volume's border and where B-scans are missing, closed everywhere else. `occupancy` is the
  // grid's. Calls abandoned() before each slab between two slow samples; if it returns true,
  // returns false with the mesh unfinished.
  template <typename Abandoned>
  bool extract(const IsoGrid& grid, const Occupancy& occupancy, float level, IsoMesh& mesh,
               const Abandoned& abandoned) {
    begin(grid, level, mesh);
    for (int b = 0; b + 1 < grid.b_scans; ++b) {
      if (abandoned())
        return false;
      extract_slab(grid, occupancy, b, mesh);
    }
    return true;
  }

private:
  struct Cell {
    int z, a, b;
  };
  void begin(const IsoGrid& grid, float level, IsoMesh& mesh);
  void extract_slab(const IsoGrid& grid, const Occupancy& occupancy, int b, IsoMesh& mesh);
  void extract_cells(const IsoGrid& grid, Cell first, int end, IsoMesh& mesh);
  void add_triangles(const IsoGrid& grid, const Cell& cell, unsigned inside, IsoMesh& mesh);
  std::uint32_t vertex_on(const IsoGrid& grid, const Cell& cell, int edge, IsoMesh& mesh);
  IsoVertex make_vertex(const IsoGrid& grid, const Cell& from, int axis) const;

  std::uint32_t threshold_ = 0; // in the grid's unit: inside is at least that
  // Vertices by the edge that they are on: along depth and fast axis in the slab's two slices,
  // along the slow axis between them.
  std::array<std::vector<std::uint32_t>, 2> along_depth_, along_a_;
  std::vector<std::uint32_t> along_b_;
};

// Removes connected pieces smaller than `least_area_mm2`: speckle that smoothing left. Keeps the
// order of the others. Allocates as the mesh grows.
class IsoCleaner {
public:
  void drop_small_pieces(float least_area_mm2, IsoMesh& mesh);

private:
  std::uint32_t root_of(std::uint32_t vertex);

  std::vector<std::uint32_t> parents_; // of vertices that hang together
  std::vector<float> areas_;           // of each root's piece
  std::vector<std::uint32_t> places_;  // of vertices, in what is left
};

} // namespace octascope::pipeline
