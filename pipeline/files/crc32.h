// The checksum of zlib and PNG.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace octascope::pipeline {

// As zlib.crc32() of Python has it.
std::uint32_t crc32_of(std::span<const std::byte> bytes);

} // namespace octascope::pipeline
