// Pixel-buffer uploads: the caller copies into the driver's memory and goes on; the transfer to the
// texture overlaps with drawing.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "hal/result.h"
#include "ui/gl/objects.h"

namespace octascope::ui::gl {

// Three buffers in turn, so that no pending transfer is waited for.
//
// Threads: as gl/objects.h. Allocates in create() only.
class PixelUploader {
public:
  static PixelUploader create(std::size_t bytes);

  std::size_t bytes() const { return bytes_; }

  // Copies `pixels` (at most bytes()) into the next buffer and leaves it bound to
  // GL_PIXEL_UNPACK_BUFFER: texture updates with offset 0 read from it. unbind() afterwards.
  hal::Result<> stage(std::span<const std::uint8_t> pixels);
  static void unbind() { glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0); }

private:
  std::array<Buffer, 3> buffers_;
  std::size_t bytes_ = 0;
  std::size_t next_ = 0;
};

} // namespace octascope::ui::gl
