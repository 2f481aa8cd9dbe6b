#include "ui/gl/pixel_uploader.h"

#include <cstring>

#include "ui/gl/context_info.h"

namespace octascope::ui::gl {

PixelUploader PixelUploader::create(std::size_t bytes) {
  PixelUploader uploader;
  uploader.bytes_ = bytes;
  uploader.software_ = describe_context().software;
  if (uploader.software_)
    return uploader;
  for (Buffer& buffer : uploader.buffers_) {
    buffer = Buffer::make();
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, buffer.name());
    glBufferData(GL_PIXEL_UNPACK_BUFFER, static_cast<GLsizeiptr>(bytes), nullptr, GL_STREAM_DRAW);
  }
  unbind();
  return uploader;
}

hal::Result<const void*> PixelUploader::stage(std::span<const std::uint8_t> pixels) {
  if (pixels.size() > bytes_)
    return hal::fail(hal::ErrorCode::invalid_argument,
                     "pixel upload: {} bytes given, expected at most {}", pixels.size(), bytes_);
  if (software_)
    return static_cast<const void*>(pixels.data());
  glBindBuffer(GL_PIXEL_UNPACK_BUFFER, buffers_[next_].name());
  next_ = (next_ + 1) % buffers_.size();
  void* memory = glMapBufferRange(GL_PIXEL_UNPACK_BUFFER, 0, static_cast<GLsizeiptr>(pixels.size()),
                                  GL_MAP_WRITE_BIT | GL_MAP_INVALIDATE_BUFFER_BIT);
  if (memory == nullptr) {
    unbind();
    return hal::fail(
        hal::ErrorCode::system,
        "pixel upload: the driver maps no {} bytes (GL error 0x{:04x}); free graphics memory",
        pixels.size(), glGetError());
  }
  std::memcpy(memory, pixels.data(), pixels.size());
  if (glUnmapBuffer(GL_PIXEL_UNPACK_BUFFER) != GL_TRUE) {
    unbind();
    return hal::fail(hal::ErrorCode::system,
                     "pixel upload: the driver lost the buffer's contents; upload again");
  }
  return static_cast<const void*>(nullptr);
}

} // namespace octascope::ui::gl
