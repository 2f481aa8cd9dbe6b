// Samples as cameras send them, and how they become one of 16 bits each: of 10 and 12 bits without
// gaps, of 8 bits, and of another depth than is wanted. Layouts: EMVA Pixel Format Naming Convention
// 2.x, "p" (a stream of bits, least significant first), and GigE Vision 1.x, "Packed" (two samples in
// three bytes, the lowest bits of both in the second). Pure.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace octascope::hal::linux_backend {

enum class Packing : std::uint8_t { none, mono8, mono10p, mono12p, mono10_packed, mono12_packed };

// Samples come in whole groups of so many in any of these layouts; a line of other lengths does not
// begin at a byte.
inline constexpr int packed_group = 4;

// Of `samples`, a multiple of packed_group. 0 for Packing::none, which is not unpacked.
std::size_t packed_bytes(Packing packing, std::size_t samples);

// In place: `frame` begins with the packed samples and has room for 2 bytes of each of `samples`;
// they lie in it little-endian then, right-justified. Not reentrant for one frame.
void unpack(Packing packing, std::span<std::byte> frame, std::size_t samples);

// Samples of 16 bits that have `from_bits`, at least half of `to_bits`, have `to_bits` then, in place:
// 0 stays 0 and full scale is full scale. A shorter sample is repeated in the bits below it, which
// differs from the exact ratio by less than one count; of a longer one the lowest bits are dropped.
void rescale(std::span<std::byte> frame, std::size_t samples, int from_bits, int to_bits);

} // namespace octascope::hal::linux_backend
