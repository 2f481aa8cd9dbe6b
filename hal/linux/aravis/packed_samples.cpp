#include "hal/linux/aravis/packed_samples.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

namespace octascope::hal::linux_backend {

namespace {

static_assert(std::endian::native == std::endian::little, "as the samples on the wire");

using Word = std::uint64_t;

constexpr Word low_bits(unsigned count) {
  return (Word{1} << count) - 1;
}

// Four samples of so many bits without gaps become one of 16 bits each: first two and two are moved
// apart, then those.
template <unsigned bits> constexpr Word spread(Word packed) {
  constexpr Word two = low_bits(2 * bits);
  constexpr Word one = low_bits(bits) | low_bits(bits) << 32U;
  const Word pairs = (packed & two) | (packed >> (2 * bits) & two) << 32U;
  return (pairs & one) | (pairs & one << bits) << (16 - bits);
}

// In each group of 24 bits, of which four samples have two.
constexpr Word in_both(Word mask) {
  return mask | mask << 24U;
}

// Each layout: the bytes of four samples, and the samples of such bytes, which are the lowest of a
// word, with anything above them.
struct Mono8 {
  static constexpr std::size_t bytes = 4;
  static Word read(Word from) { return spread<8>(from); }
};

struct Mono10p {
  static constexpr std::size_t bytes = 5;
  static Word read(Word from) { return spread<10>(from); }
};

struct Mono12p {
  static constexpr std::size_t bytes = 6;
  static Word read(Word from) { return spread<12>(from); }
};

struct Mono10Packed {
  static constexpr std::size_t bytes = 6;
  static Word read(Word from) {
    const Word first = (from & in_both(0xFF)) << 2U | (from >> 8U & in_both(0x3));
    const Word second = (from & in_both(0xFF0000)) >> 2U | (from & in_both(0x3000));
    return spread<12>(first | second);
  }
};

struct Mono12Packed {
  static constexpr std::size_t bytes = 6;
  static Word read(Word from) {
    const Word first = (from & in_both(0xFF)) << 4U | (from >> 8U & in_both(0xF));
    const Word second = from & in_both(0xFFF000);
    return spread<12>(first | second);
  }
};

// Of so many words at once, for which compilers have vectors.
template <class Layout, std::size_t count>
void unpack_words(std::span<std::byte> frame, std::size_t first) {
  std::array<Word, count> words{};
  for (std::size_t i = 0; i < count; ++i)
    std::memcpy(&words[i], frame.data() + (first + i) * Layout::bytes, sizeof(Word));
  for (std::size_t i = 0; i < count; ++i)
    words[i] = Layout::read(words[i]);
  std::memcpy(frame.data() + first * sizeof(Word), words.data(), sizeof(words));
}

// From the last to the first: what is written lies behind what is still to be read. A word that is
// read ends within what it becomes.
template <class Layout> void unpack_as(std::span<std::byte> frame, std::size_t samples) {
  constexpr std::size_t at_once = 16;
  std::size_t word = samples / 4;
  while (word % at_once != 0)
    unpack_words<Layout, 1>(frame, --word);
  for (; word > 0; word -= at_once)
    unpack_words<Layout, at_once>(frame, word - at_once);
}

} // namespace

std::size_t packed_bytes(Packing packing, std::size_t samples) {
  switch (packing) {
  case Packing::none: break;
  case Packing::mono8: return samples;
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
  case Packing::mono8: return unpack_as<Mono8>(frame, samples);
  case Packing::mono10p: return unpack_as<Mono10p>(frame, samples);
  case Packing::mono12p: return unpack_as<Mono12p>(frame, samples);
  case Packing::mono10_packed: return unpack_as<Mono10Packed>(frame, samples);
  case Packing::mono12_packed: return unpack_as<Mono12Packed>(frame, samples);
  }
}

void rescale(std::span<std::byte> frame, std::size_t samples, int from_bits, int to_bits) {
  if (from_bits == to_bits)
    return;
  const int up = std::max(0, to_bits - from_bits);
  const int down = from_bits - up; // of the copy below; all of it, where there is none
  const int drop = std::max(0, from_bits - to_bits);
  for (std::size_t i = 0; i < samples; ++i) {
    std::uint16_t sample = 0;
    std::memcpy(&sample, frame.data() + i * sizeof(sample), sizeof(sample));
    const auto wide = static_cast<std::uint16_t>(sample << up);
    const auto below = static_cast<std::uint16_t>(sample >> down);
    sample = static_cast<std::uint16_t>(static_cast<std::uint16_t>(wide | below) >> drop);
    std::memcpy(frame.data() + i * sizeof(sample), &sample, sizeof(sample));
  }
}

} // namespace octascope::hal::linux_backend
