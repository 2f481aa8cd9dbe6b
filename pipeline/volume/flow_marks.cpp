#include "pipeline/volume/flow_marks.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include "pipeline/threads/cpu_clones.h"

namespace octascope::pipeline {

namespace {

constexpr int bins_of_byte = 8;
constexpr int cells_of_word = 4; // along the fast axis
static_assert(first_marked_flow == 0x80, "the counts' highest bits say what is marked");
static_assert(std::endian::native == std::endian::little, "bit 0 is the first byte's");

// Nearly all blocks of so many counts have nothing marked.
constexpr std::size_t block_words = 8;
constexpr std::size_t block = block_words * bins_of_byte;

constexpr std::uint64_t highest_bits = 0x8080'8080'8080'8080;

bool any_marked(const std::uint8_t* counts) {
  std::array<std::uint64_t, block_words> eights{};
  std::memcpy(eights.data(), counts, block);
  std::uint64_t any = 0;
  for (const std::uint64_t eight : eights)
    any |= eight;
  return (any & highest_bits) != 0;
}

// The highest bits of up to eight counts, the first one lowest.
std::uint32_t marked_of(const std::uint8_t* counts, std::size_t size) {
  std::uint64_t eight = 0;
  std::memcpy(&eight, counts, size);
  constexpr std::uint64_t lowest_bits = 0x0101'0101'0101'0101;
  constexpr std::uint64_t into_highest_byte = 0x0102'0408'1020'4080;
  return static_cast<std::uint32_t>((((eight >> 7U) & lowest_bits) * into_highest_byte) >> 56U);
}

// A cell lies between a bin and the one below it. `words`: where a bin is marked.
OCTASCOPE_CPU_CLONES
void join_bins(std::uint32_t* words, int count) {
  for (int i = 0; i < count - 1; ++i) {
    const std::uint32_t below = (words[i + 1] & 0x0101'0101U) << 7U;
    words[i] |= (words[i] >> 1U & 0x7F7F'7F7FU) | below;
  }
  words[count - 1] |= words[count - 1] >> 1U & 0x7F7F'7F7FU;
}

} // namespace

FlowMarks::FlowMarks(const VolumeGeometry& geometry, int first_depth)
    : geometry_{geometry}, row_{geometry.depths / bins_of_byte + 1},
      slab_{row_ * (geometry.a_scans / cells_of_word + 1)},
      ignored_{static_cast<std::uint8_t>((1U << static_cast<unsigned>(first_depth)) - 1U)},
      words_(static_cast<std::size_t>(slab_) * static_cast<std::size_t>(geometry.b_scans)) {}

// Those of the cells at both sides of an A-scan.
void FlowMarks::mark_sides(std::span<std::uint32_t> words, int a,
                           std::span<const std::uint8_t> counts) const noexcept {
  const auto first_word = [&](int cell) {
    return words.data() + static_cast<std::ptrdiff_t>(cell / cells_of_word) * row_;
  };
  const auto shift = [](int cell) { return static_cast<unsigned>(cell % cells_of_word * 8); };
  std::uint32_t* const left = first_word(a);
  std::uint32_t* const right = first_word(a + 1);
  for (std::size_t from = 0; from < counts.size(); from += block) {
    const std::size_t to = std::min(from + block, counts.size());
    if (to - from == block && !any_marked(counts.data() + from))
      continue;
    for (std::size_t z = from; z < to; z += bins_of_byte) {
      std::uint32_t marked =
          marked_of(counts.data() + z, std::min<std::size_t>(bins_of_byte, to - z));
      if (z == 0)
        marked &= ~std::uint32_t{ignored_};
      left[z / bins_of_byte] |= marked << shift(a);
      right[z / bins_of_byte] |= marked << shift(a + 1);
    }
  }
}

void FlowMarks::update(int b, std::span<const std::uint8_t> counts) noexcept {
  const auto depths = static_cast<std::size_t>(geometry_.depths);
  const std::span<std::uint32_t> words = own(b);
  std::ranges::fill(words, 0U);
  for (int a = 0; a < geometry_.a_scans; ++a)
    mark_sides(words, a, counts.subspan(static_cast<std::size_t>(a) * depths, depths));
  for (std::int32_t at = 0; at < slab_; at += row_)
    join_bins(words.data() + at, row_);
}

void FlowMarks::clear(int b) noexcept {
  std::ranges::fill(own(b), 0U);
}

void FlowMarks::copy(int b, const FlowMarks& from) noexcept {
  std::ranges::copy(from.of(b), own(b).begin());
}

} // namespace octascope::pipeline
