// Pictures of motion JPEG, by libjpeg-turbo.
#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include "hal/linux/libcamera/format_choice.h"
#include "hal/result.h"

namespace octascope::hal::linux_backend {

// Threads: one at a time.
class MotionJpegDecoder {
public:
  // ErrorCode::system: no memory.
  static Result<MotionJpegDecoder> make();

  // One picture into `rgb`, rows of 3 · width bytes from the top. Cameras leave out the Huffman
  // tables and put a few bytes too many between segments: both are fine. ErrorCode::bad_data: it is
  // broken off, damaged, or not of this size; `rgb` then holds no picture.
  Result<> decode(std::span<const std::byte> jpeg, PictureSize size, std::span<std::byte> rgb);

private:
  struct Destroy {
    void operator()(void* handle) const;
  };
  explicit MotionJpegDecoder(void* handle) : handle_{handle} {}
  Result<> try_to_decode(std::span<const std::byte> jpeg, PictureSize size,
                         std::span<std::byte> rgb);

  std::unique_ptr<void, Destroy> handle_;
};

} // namespace octascope::hal::linux_backend
