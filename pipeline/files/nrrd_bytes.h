// Reads the bytes of a NRRD's volume in order, unpacking them if needed.
#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include "pipeline/files/nrrd_header.h"

namespace octascope::pipeline {

// Of a whole volume.
struct NrrdSize {
  std::size_t bytes;
  std::string words; // "96 = 4 × 3 × 2 × 4"

  tl::unexpected<hal::Error> refuse(const NrrdHeader& header, std::size_t found) const;
};

class NrrdBytes {
public:
  // Begins after the header's `line skip` and `byte skip`. `data` is the data file, or what follows
  // an attached header; it must outlive this. ErrorCode::bad_data: the encoding is not supported,
  // or `data` is too short for `expected`. This is checked here so that no caller allocates memory
  // for a volume that the file cannot hold.
  static hal::Result<std::unique_ptr<NrrdBytes>>
  open(const NrrdHeader& header, std::span<const std::byte> data, const NrrdSize& expected);
  virtual ~NrrdBytes() = default;

  // Fills `bytes` and returns how many there were, fewer than its size only at the end.
  virtual hal::Result<std::size_t> read(std::span<std::byte> bytes) = 0;
};

} // namespace octascope::pipeline
