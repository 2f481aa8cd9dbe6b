// How near the surroundings of each place of the sharp picture are: the first two moments of the
// distances around it, on a grid of cells of 4 × 4 pixels. A pixel is occluded by the share of its
// surroundings that lies before it, which Chebyshev's inequality bounds by these moments; so a
// vessel throws a soft shade on what lies behind it, and none on itself.
//
// Sources: T. Luft, C. Colditz, O. Deussen, "Image enhancement by unsharp masking the depth
// buffer" (SIGGRAPH 2006); W. Donnelly, A. Lauritzen, "Variance shadow maps" (I3D 2006).
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "ui/depth_mask/depth_image.h"

namespace octascope::ui {

inline constexpr int occlusion_cell = 4;  // pixels
inline constexpr int occlusion_reach = 6; // cells, in which the weights fall to nothing
inline constexpr float occlusion_reach_px = occlusion_cell * occlusion_reach;

// Means over the surroundings, of cells in rows from the top; distances from `origin_mm` on.
struct OcclusionMoments {
  const float* coverage = nullptr; // null: nothing is occluded
  const float* distance = nullptr; // times coverage
  const float* square = nullptr;   // likewise
  int columns = 0;
  int rows = 0;
  float origin_mm = 0;
};

// Threads: rows may be shared out; all of gather() before the first of spread().
class OcclusionField {
public:
  // Allocates only to grow. `origin_mm`: near what is drawn, for precision.
  void resize(int width, int height, float origin_mm);
  int rows() const { return rows_; }

  // Rows [first, end) of cells.
  void gather(const DepthImage& sharp, int first, int end);
  void spread(int first, int end);

  OcclusionMoments moments() const {
    return {spread_[0].data(), spread_[1].data(), spread_[2].data(), columns_, rows_, origin_mm_};
  }

private:
  using Planes = std::array<std::vector<float>, 3>;

  int columns_ = 0;
  int rows_ = 0;
  float origin_mm_ = 0;
  Planes gathered_; // smoothed along the rows
  Planes spread_;   // and along the columns
};

} // namespace octascope::ui
