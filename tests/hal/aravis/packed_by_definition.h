// Packs samples bit by bit, as the Pixel Format Naming Convention and GigE Vision define it.
#pragma once

#include <cstddef>
#include <vector>

#include "hal/linux/aravis/packed_samples.h"

namespace octascope::tests {

inline int bits_of(hal::linux_backend::Packing packing) {
  using hal::linux_backend::Packing;
  return packing == Packing::mono10p || packing == Packing::mono10_packed ? 10 : 12;
}

// The bit of the frame, counted from the lowest of its first byte, that has this bit of a sample.
inline std::size_t place_of_bit(hal::linux_backend::Packing packing, std::size_t sample, int bit) {
  using hal::linux_backend::Packing;
  const int bits = bits_of(packing);
  const auto number = static_cast<std::size_t>(bit);
  if (packing == Packing::mono10p || packing == Packing::mono12p)
    return sample * static_cast<std::size_t>(bits) + number;
  // The highest 8 bits in the first and third byte of three, the lowest in the halves of the second.
  const bool second = sample % 2 == 1;
  const std::size_t group = sample / 2 * 24;
  const int low = bits - 8;
  if (bit >= low)
    return group + (second ? 16 : 0) + number - static_cast<std::size_t>(low);
  return group + 8 + (second ? 4 : 0) + number;
}

inline std::vector<std::byte> pack_by_definition(hal::linux_backend::Packing packing,
                                                 const std::vector<int>& samples) {
  std::vector<std::byte> packed(hal::linux_backend::packed_bytes(packing, samples.size()));
  for (std::size_t i = 0; i < samples.size(); ++i)
    for (int bit = 0; bit < bits_of(packing); ++bit)
      if ((samples[i] >> bit & 1) != 0) {
        const std::size_t place = place_of_bit(packing, i, bit);
        packed[place / 8] |= std::byte{1} << (place % 8);
      }
  return packed;
}

} // namespace octascope::tests
