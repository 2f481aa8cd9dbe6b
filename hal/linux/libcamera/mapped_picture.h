// A picture's memory, shared by the camera, as bytes that the processor reads.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "hal/linux/libcamera/plane_plan.h"
#include "hal/result.h"

namespace octascope::hal::linux_backend {

// Owns the mappings, borrows the descriptors: they outlive it. Threads: one at a time.
class MappedPicture {
public:
  // `device` is named in the Error. `bytes` is the whole picture's size, for one in pieces.
  static Result<MappedPicture> map(const PlanePlan& plan, std::size_t bytes,
                                   std::string_view device);
  MappedPicture(MappedPicture&&) noexcept = default;
  MappedPicture& operator=(MappedPicture&&) noexcept = default;
  ~MappedPicture() = default;

  // Between the two the processor sees what the device wrote. Pieces that lie apart are put
  // together here, in memory of ours; else nothing is copied. Allocates nothing.
  std::span<const std::byte> begin_reading();
  void end_reading();

private:
  class Mapping {
  public:
    Mapping(void* address, std::size_t length, int descriptor)
        : address_{static_cast<const std::byte*>(address)}, length_{length}, descriptor_{
                                                                                 descriptor} {}
    Mapping(Mapping&& other) noexcept;
    Mapping& operator=(Mapping&& other) noexcept;
    ~Mapping();
    const std::byte* address() const { return address_; }
    int descriptor() const { return descriptor_; }

  private:
    const std::byte* address_;
    std::size_t length_;
    int descriptor_;
  };

  MappedPicture() = default;
  void synchronise(std::uint64_t flags);

  std::vector<Mapping> mappings_; // one a file of the plan
  std::vector<PlanePlan::Piece> pieces_;
  std::vector<std::byte> gathered_; // empty for a picture in one piece
  bool reading_ = false;
};

} // namespace octascope::hal::linux_backend
