#include "hal/linux/aravis/packed_samples.h"

#include <array>
#include <cstring>

namespace octascope::hal::linux_backend {

namespace {

template <std::size_t count> using Samples = std::array<std::uint16_t, count>;

template <std::size_t count> std::array<unsigned, count> load(const std::byte* bytes) {
  std::array<unsigned, count> numbers{};
  for (std::size_t i = 0; i < count; ++i)
    numbers[i] = std::to_integer<unsigned>(bytes[i]);
  return numbers;
}

constexpr std::uint16_t sample(unsigned bits, unsigned mask) {
  return static_cast<std::uint16_t>(bits & mask);
}

// One group of each layout: so many bytes, so many samples.
struct Mono10p {
  static constexpr std::size_t bytes = 5;
  static constexpr std::size_t samples = 4;
  static Samples<4> read(const std::byte* from) {
    const auto b = load<5>(from);
    return {sample(b[0] | b[1] << 8U, 0x3FF), sample(b[1] >> 2U | b[2] << 6U, 0x3FF),
            sample(b[2] >> 4U | b[3] << 4U, 0x3FF), sample(b[3] >> 6U | b[4] << 2U, 0x3FF)};
  }
};

struct Mono12p {
  static constexpr std::size_t bytes = 3;
  static constexpr std::size_t samples = 2;
  static Samples<2> read(const std::byte* from) {
    const auto b = load<3>(from);
    return {sample(b[0] | b[1] << 8U, 0xFFF), sample(b[1] >> 4U | b[2] << 4U, 0xFFF)};
  }
};

struct Mono10Packed {
  static constexpr std::size_t bytes = 3;
  static constexpr std::size_t samples = 2;
  static Samples<2> read(const std::byte* from) {
    const auto b = load<3>(from);
    return {sample(b[0] << 2U | (b[1] & 3U), 0x3FF), sample(b[2] << 2U | (b[1] >> 4U & 3U), 0x3FF)};
  }
};

struct Mono12Packed {
  static constexpr std::size_t bytes = 3;
  static constexpr std::size_t samples = 2;
  static Samples<2> read(const std::byte* from) {
    const auto b = load<3>(from);
    return {sample(b[0] << 4U | (b[1] & 15U), 0xFFF), sample(b[2] << 4U | b[1] >> 4U, 0xFFF)};
  }
};

// From the last group to the first: what is written lies behind what is still to be read.
template <class Layout> void unpack_as(std::span<std::byte> frame, std::size_t samples) {
  for (std::size_t group = samples / Layout::samples; group-- > 0;) {
    const auto read = Layout::read(frame.data() + group * Layout::bytes);
    std::memcpy(frame.data() + group * sizeof(read), read.data(), sizeof(read));
  }
}

} // namespace

std::size_t packed_bytes(Packing packing, std::size_t samples) {
  switch (packing) {
  case Packing::none: break;
  case Packing::mono10p: return samples / 4 * 5;
  case Packing::mono12p:
  case Packing::mono10_packed:
  case Packing::mono12_packed: return samples / 2 * 3;
  }
  return 0;
}

void unpack(Packing packing, std::span<std::byte> frame, std::size_t samples) {
  switch (packing) {
  case Packing::none: return;
  case Packing::mono10p: return unpack_as<Mono10p>(frame, samples);
  case Packing::mono12p: return unpack_as<Mono12p>(frame, samples);
  case Packing::mono10_packed: return unpack_as<Mono10Packed>(frame, samples);
  case Packing::mono12_packed: return unpack_as<Mono12Packed>(frame, samples);
  }
}

} // namespace octascope::hal::linux_backend
