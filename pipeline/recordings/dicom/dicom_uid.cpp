#include "pipeline/recordings/dicom/dicom_uid.h"

#include <algorithm>
#include <array>
#include <cstdint>

#include <xxhash.h>

namespace octascope::pipeline {

namespace {

// Most significant first.
using Uuid = std::array<std::uint32_t, 4>;

Uuid uuid_of(std::string_view name) {
  const XXH128_hash_t hash = XXH3_128bits(name.data(), name.size());
  Uuid uuid{static_cast<std::uint32_t>(hash.high64 >> 32), static_cast<std::uint32_t>(hash.high64),
            static_cast<std::uint32_t>(hash.low64 >> 32), static_cast<std::uint32_t>(hash.low64)};
  uuid[1] = (uuid[1] & 0xFFFF0FFF) | 0x8000;     // version 8
  uuid[2] = (uuid[2] & 0x3FFFFFFF) | 0x80000000; // the variant of RFC 9562
  return uuid;
}

// Divides by ten; the remainder.
std::uint32_t take_digit(Uuid& number) {
  std::uint64_t remainder = 0;
  for (std::uint32_t& part : number) {
    remainder = remainder << 32 | part;
    part = static_cast<std::uint32_t>(remainder / 10);
    remainder %= 10;
  }
  return static_cast<std::uint32_t>(remainder);
}

} // namespace

std::string derive_uid(std::string_view name) {
  Uuid number = uuid_of(name);
  std::string digits;
  do
    digits += static_cast<char>('0' + take_digit(number));
  while (std::ranges::any_of(number, [](std::uint32_t part) { return part != 0; }));
  std::ranges::reverse(digits);
  return "2.25." + digits;
}

} // namespace octascope::pipeline
