// The type of one sample of a raw spectrum: little-endian counts from a camera, or values from a
// file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace octascope::hal {

enum class SampleType : std::uint8_t {
  u8,
  u16, // also samples of 10, 12 and 14 bits
  f32, // only from files
};

constexpr std::size_t bytes_per_sample(SampleType type) {
  return type == SampleType::u8 ? 1 : type == SampleType::u16 ? 2 : 4;
}

constexpr std::string_view to_string(SampleType type) {
  return type == SampleType::u8 ? "u8" : type == SampleType::u16 ? "u16" : "f32";
}

} // namespace octascope::hal
