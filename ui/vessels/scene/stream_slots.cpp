#include "ui/vessels/scene/stream_slots.h"

namespace octascope::ui {

StreamSlots::StreamSlots(std::size_t slots, std::size_t bytes)
    : memory_(slots, nullptr), bytes_{bytes} {
  for (std::size_t i = 0; i < slots; ++i) {
    buffers_.push_back(gl::Buffer::make());
    glBindBuffer(GL_ARRAY_BUFFER, buffers_.back().name());
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(bytes), nullptr, GL_STREAM_DRAW);
  }
}

hal::Result<> StreamSlots::open(std::size_t slot) {
  if (memory_[slot] != nullptr)
    return {};
  glBindBuffer(GL_ARRAY_BUFFER, buffers_[slot].name());
  memory_[slot] =
      static_cast<std::byte*>(glMapBufferRange(GL_ARRAY_BUFFER, 0, static_cast<GLsizeiptr>(bytes_),
                                               GL_MAP_WRITE_BIT | GL_MAP_INVALIDATE_BUFFER_BIT));
  if (memory_[slot] == nullptr)
    return hal::fail(hal::ErrorCode::system,
                     "vessels: the graphics driver gives no memory for {} bytes of vertices; let "
                     "GL expand the vessels (quads-gpu)",
                     bytes_);
  return {};
}

void StreamSlots::close(std::size_t slot) {
  glBindBuffer(GL_ARRAY_BUFFER, buffers_[slot].name());
  glUnmapBuffer(GL_ARRAY_BUFFER);
  memory_[slot] = nullptr;
}

} // namespace octascope::ui
