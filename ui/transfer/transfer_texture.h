// The transfer function as shaders sample it.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "ui/gl/objects.h"
#include "ui/transfer/transfer_table.h"
#include "ui/transfer/visible_levels.h"

namespace octascope::ui {

// The table's entries in the rows of an RGBA32F texture: colour, and the opacity of one reference
// step. Shaders fetch two neighbours and interpolate (transfer.glsl), since GL ES 3.0 guarantees
// filtering of 16 bits only, too few for what is nearly opaque, and 2048 texels in a row, half a
// table.
//
// Threads: as gl/objects.h. update() allocates nothing.
class TransferTexture {
public:
  static constexpr int row_bits = 11;
  static constexpr int width = 1 << row_bits;
  static constexpr int height = (TransferTable::entries + width - 1) / width;

  TransferTexture();

  // Uploads the table unless it is the same as the last one.
  void update(const TransferTable& table);

  GLuint name() const { return texture_.name(); }
  // If the table is a display window, shaders compute it: a look-up is slower in a software
  // rasteriser.
  const std::optional<TransferTable::Window>& window() const { return window_; }
  // The visible levels.
  const VisibleLevels& visible() const { return visible_; }
  // Counts the uploads: 0 before the first.
  std::uint64_t version() const { return version_; }

private:
  gl::Texture texture_;
  std::vector<float> texels_; // RGBA
  std::optional<TransferTable::Window> window_;
  VisibleLevels visible_;
  std::uint64_t version_ = 0;
};

} // namespace octascope::ui
