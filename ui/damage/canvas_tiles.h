// Where a frame's canvases differ from those of the frame before.
//
// Of each tile a hash is kept of all triangles that meet it, in their order, with everything that
// decides their pixels. So whatever is drawn on a canvas is compared by what it is, not by what
// somebody says about it. Two tiles of equal hashes (64 bits) are taken for equal.
#pragma once

#include <cstdint>
#include <vector>

#include "ui/canvas/canvas.h"
#include "ui/damage/damage.h"

namespace octascope::ui {

// Threads: one at a time. Allocates when the size grows.
class CanvasTiles {
public:
  // A frame begins. Of another size than the one before, all of it is different.
  void begin(int width, int height);
  // In the order in which they are drawn.
  void add(const Canvas& canvas);
  // Adds the tiles that differ. `damage` must have the size of begin().
  void compare(Damage& damage);

private:
  void add_triangle(const struct Corners& corners, std::uint64_t hash, const Rect& clip);

  int width_ = 0;
  int height_ = 0;
  int across_ = 0;
  int down_ = 0;
  bool comparable_ = false;           // with the frame before
  std::vector<std::uint64_t> tiles_;  // [row][column] of this frame
  std::vector<std::uint64_t> before_; // of the frame before
};

} // namespace octascope::ui
