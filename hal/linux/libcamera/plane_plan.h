// Where an image's bytes are in the dma-bufs that a camera shares. Pure.
#pragma once

#include <cstddef>
#include <vector>

#include "hal/linux/libcamera/format_choice.h"
#include "hal/result.h"

namespace octascope::hal::linux_backend {

struct BufferPlane {
  int descriptor = -1; // of a dma-buf; borrowed
  std::size_t offset = 0;
  std::size_t length = 0;
};

struct PictureLayout {
  Encoding encoding = Encoding::nv12;
  PictureSize size;
  std::size_t stride = 0; // bytes from row to row; meaningless for motion_jpeg

  // From the first byte of the first row to the last of the last row; 0 for motion_jpeg.
  std::size_t bytes() const {
    const std::size_t rows = row_count(encoding, size.height);
    return rows == 0 || encoding == Encoding::motion_jpeg
               ? 0
               : stride * (rows - 1) + row_bytes(encoding, size.width);
  }
};

struct PlanePlan {
  struct File { // mapped from offset 0
    int descriptor = -1;
    std::size_t length = 0;
  };
  struct Piece {          // of the image, from the top
    std::size_t file = 0; // in `files`
    std::size_t offset = 0;
    std::size_t length = 0;
    std::size_t place = 0; // offset in the image
  };
  std::vector<File> files;
  std::vector<Piece> pieces; // one for a contiguous image, two for NV12's luma and chroma
};

// ErrorCode::bad_data: the planes cannot hold such an image; the message has both sizes.
Result<PlanePlan> plan_planes(const std::vector<BufferPlane>& planes, const PictureLayout& layout);

} // namespace octascope::hal::linux_backend
