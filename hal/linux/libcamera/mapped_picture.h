// Maps a buffer shared by the camera, so that the processor can read the image.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "hal/linux/libcamera/plane_plan.h"
#include "hal/result.h"

namespace octascope::hal::linux_backend {

// Owns the mappings; borrows the descriptors, which must outlive it. Threads: one at a time.
class MappedPicture {
public:
  // `device` is named in the Error. `bytes` is the size of the whole image, for one in pieces.
  static Result<MappedPicture> map(const PlanePlan& plan, std::size_t bytes,
                                   std::string_view device);

  // Between these two calls the processor sees what the device wrote. An image in pieces is copied
  // into one; otherwise nothing is copied. Does not allocate.
  std::span<const std::byte> begin_reading();
  void end_reading();

private:
  struct Unmap {
    std::size_t length;
    void operator()(const std::byte* address) const;
  };
  struct Mapping {
    std::unique_ptr<const std::byte[], Unmap> bytes;
    int descriptor;
  };

  MappedPicture() = default;
  void synchronise(std::uint64_t flags);

  std::vector<Mapping> mappings_; // one per file of the plan
  std::vector<PlanePlan::Piece> pieces_;
  std::vector<std::byte> gathered_; // empty for an image in one piece
  bool reading_ = false;
};

} // namespace octascope::hal::linux_backend
