// The transfer function as a texture for shaders.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "ui/gl/objects.h"
#include "ui/transfer/transfer_table.h"
#include "ui/transfer/visible_levels.h"

namespace octascope::ui {

// An RGBA32F texture with the table's entries, row after row: colour, and the opacity of one
// reference step. Shaders fetch two neighbours and interpolate (transfer.glsl), because GL ES 3.0
// guarantees filtering only for 16-bit texels, which are too coarse for nearly opaque values, and
// only 2048 texels per row, which is half a table.
//
// Threads: as gl/objects.h. update() allocates nothing.
class TransferTexture {
public:
  static constexpr int row_bits = 11;
  static constexpr int width = 1 << row_bits;
  static constexpr int height = (TransferTable::entries + width - 1) / width;

  TransferTexture();

  // Uploads the table if it differs from the last one.
  void update(const TransferTable& table);

  GLuint name() const { return texture_.name(); }
  // Set if the table is a display window: shaders then compute it, because a software rasteriser
  // takes longer to look it up.
  const std::optional<TransferTable::Window>& window() const { return window_; }
  // Set if the colours get their hue from the depth.
  const std::optional<DepthColours>& depths() const { return depths_; }
  // The levels that are visible in shaders.
  const VisibleLevels& visible() const { return visible_; }
  // Counts the uploads; 0 before the first.
  std::uint64_t version() const { return version_; }

private:
  gl::Texture texture_;
  std::vector<float> texels_; // RGBA
  std::optional<TransferTable::Window> window_;
  std::optional<DepthColours> depths_;
  VisibleLevels visible_;
  std::uint64_t version_ = 0;
};

} // namespace octascope::ui
