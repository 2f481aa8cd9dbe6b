// Pixel-buffer uploads: the caller copies into driver memory; the transfer to the texture runs
// asynchronously. Where the processor is the GPU that would be one copy more: textures then read
// from the caller's memory.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "hal/result.h"
#include "ui/gl/objects.h"

namespace octascope::ui::gl {

// Cycles through three buffers, so that it never waits for a transfer in progress; a software
// rasteriser needs none.
//
// Threads: as gl/objects.h. Allocates in create() only.
class PixelUploader {
public:
  static PixelUploader create(std::size_t bytes);

  std::size_t bytes() const { return bytes_; }

  // Where the next texture update reads `pixels` (at most bytes()) from: in a buffer, which is left
  // bound to GL_PIXEL_UNPACK_BUFFER, or where they are. unbind() afterwards.
  hal::Result<const void*> stage(std::span<const std::uint8_t> pixels);
  static void unbind() { glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0); }

private:
  std::array<Buffer, 3> buffers_;
  bool software_ = false;
  std::size_t bytes_ = 0;
  std::size_t next_ = 0;
};

} // namespace octascope::ui::gl
