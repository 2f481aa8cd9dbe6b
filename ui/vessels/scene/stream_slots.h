// Vertex buffers that threads fill while GL draws from others.
#pragma once

#include <cstddef>
#include <vector>

#include "hal/result.h"
#include "ui/gl/objects.h"

namespace octascope::ui {

// The slots' memory is the driver's. Once handed to GL, a slot gets fresh memory, so that GL's
// drawing is never waited for.
//
// Threads: as gl/objects.h; any thread may write a slot's memory.
class StreamSlots {
public:
  StreamSlots() = default;
  StreamSlots(std::size_t slots, std::size_t bytes);

  // ErrorCode::system: the driver has no memory. Does nothing if the slot is open.
  hal::Result<> open(std::size_t slot);
  std::byte* memory(std::size_t slot) const { return memory_[slot]; }
  // Ends writing and leaves the buffer bound to GL_ARRAY_BUFFER for drawing.
  void close(std::size_t slot);

  std::size_t count() const { return buffers_.size(); }
  GLuint name(std::size_t slot) const { return buffers_[slot].name(); }

private:
  std::vector<gl::Buffer> buffers_;
  std::vector<std::byte*> memory_; // null for those that are closed
  std::size_t bytes_ = 0;
};

} // namespace octascope::ui
