#include "pipeline/files/crc32.h"

#include <zlib.h>

namespace octascope::pipeline {

std::uint32_t crc32_of(std::span<const std::byte> bytes) {
  return static_cast<std::uint32_t>(
      ::crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

} // namespace octascope::pipeline
