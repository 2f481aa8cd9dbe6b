// Decodes motion JPEG, with libjpeg-turbo.
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
  // ErrorCode::system: out of memory.
  static Result<MotionJpegDecoder> make();

  // Decodes one image into `rgb`, rows of 3 · width bytes from the top. Accepts images without
  // Huffman tables or with a few extra bytes between segments, as cameras send them.
  // ErrorCode::bad_data: truncated, damaged or not of this size; `rgb` is then unspecified.
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
