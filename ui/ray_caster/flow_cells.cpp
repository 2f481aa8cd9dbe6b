#include "ui/ray_caster/flow_cells.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include "pipeline/threads/cpu_clones.h"
#include "ui/ray_caster/cell_volume.h"
#include "ui/transfer/flow_look.h"

namespace octascope::ui {

namespace {

constexpr int bins_of_byte = 8;
constexpr int cells_of_word = 4; // along the fast axis
static_assert(first_seen_flow == 0x80, "the counts' highest bits say what is seen");
static_assert(std::endian::native == std::endian::little, "bit 0 is the first byte's");

std::size_t as_size(std::int32_t value) {
  return static_cast<std::size_t>(value);
}

// The highest bits of eight counts, the first one lowest.
std::uint8_t seen_of(std::uint64_t counts) {
  constexpr std::uint64_t lowest_bits = 0x0101'0101'0101'0101;
  constexpr std::uint64_t into_highest_byte = 0x0102'0408'1020'4080;
  return static_cast<std::uint8_t>((((counts >> 7U) & lowest_bits) * into_highest_byte) >> 56U);
}

// Where something is seen in an A-scan, a bit for each bin.
using Seen = std::array<std::uint8_t, 4096>;
static_assert(bins_of_byte * std::tuple_size_v<Seen> > CellVolume::longest);

// An odd number of cache lines (cell_volume.cpp).
std::int32_t a_scan_stride(const pipeline::VolumeGeometry& g) {
  return 64 * (((g.depths + 1 + 63) / 64) | 1);
}

// A kernel takes four bytes of each A-scan, of which it needs two.
constexpr std::size_t loaded_beyond = 2;

// Nearly all blocks of so many counts have nothing to be seen.
constexpr std::size_t block_words = 8;
constexpr std::size_t block = block_words * bins_of_byte;

void find_seen(std::span<const std::uint8_t> counts, Seen& seen) {
  constexpr std::uint64_t highest_bits = 0x8080'8080'8080'8080;
  std::size_t at = 0;
  for (; at + block <= counts.size(); at += block) {
    std::array<std::uint64_t, block_words> eights{};
    std::memcpy(eights.data(), counts.data() + at, block);
    std::uint64_t any = 0;
    for (const std::uint64_t eight : eights)
      any |= eight;
    std::uint8_t* const to = seen.data() + at / bins_of_byte;
    if ((any & highest_bits) == 0)
      std::memset(to, 0, block_words);
    else
      std::ranges::transform(eights, to, seen_of);
  }
  for (; at + bins_of_byte <= counts.size(); at += bins_of_byte) {
    std::uint64_t eight = 0;
    std::memcpy(&eight, counts.data() + at, sizeof eight);
    seen[at / bins_of_byte] = seen_of(eight);
  }
  std::uint64_t rest = 0;
  std::memcpy(&rest, counts.data() + at, counts.size() - at);
  seen[at / bins_of_byte] = seen_of(rest);
}

// Of the A-scans at the sides of a word's cells.
using Sides = std::array<Seen, cells_of_word + 1>;

// What is seen at the sides of each cell.
OCTASCOPE_CPU_CLONES
void join_sides(const std::uint8_t* __restrict a, const std::uint8_t* __restrict b,
                const std::uint8_t* __restrict c, const std::uint8_t* __restrict d,
                const std::uint8_t* __restrict e, int words, std::uint32_t* __restrict to) {
  for (int i = 0; i < words; ++i) {
    const std::uint32_t first = a[i] | b[i];
    const std::uint32_t second = b[i] | c[i];
    const std::uint32_t third = c[i] | d[i];
    const std::uint32_t fourth = d[i] | e[i];
    to[i] = first | second << 8U | third << 16U | fourth << 24U;
  }
}

// A cell lies between a bin and the one below it. `sides` has one word more, 0.
OCTASCOPE_CPU_CLONES
void join_bins(const std::uint32_t* __restrict sides, int words, std::uint32_t cells,
               std::uint32_t* __restrict to) {
  for (int i = 0; i < words; ++i) {
    const std::uint32_t inside = sides[i] >> 1U & 0x7F7F'7F7FU;
    const std::uint32_t below = (sides[i + 1] & 0x0101'0101U) << 7U;
    to[i] = (sides[i] | inside | below) & cells;
  }
}

void find_seen_between(const Sides& sides, int words, int cells, std::uint32_t* to) {
  std::array<std::uint32_t, std::tuple_size_v<Seen> + 1> joined; // only its first words are used
  join_sides(sides[0].data(), sides[1].data(), sides[2].data(), sides[3].data(), sides[4].data(),
             words, joined.data());
  joined[as_size(words)] = 0;
  join_bins(joined.data(), words, ~std::uint32_t{0} >> (bins_of_byte * (cells_of_word - cells)),
            to);
}

} // namespace

FlowCells::FlowCells(const pipeline::VolumeGeometry& geometry)
    : geometry_{geometry}, column_bytes_{a_scan_stride(geometry)}, mark_row_{geometry.depths /
                                                                                 bins_of_byte +
                                                                             1},
      mark_slab_{mark_row_ * (geometry.a_scans / cells_of_word + 1)},
      counts_(as_size(slab_bytes()) * as_size(geometry.b_scans) + loaded_beyond),
      seen_(as_size(mark_slab_) * as_size(geometry.b_scans)),
      marks_(as_size(mark_slab_) * (as_size(geometry.b_scans) + 1) * sizeof(Word)) {}

const std::uint32_t* FlowCells::marks() const {
  return reinterpret_cast<const Word*>(marks_.data());
}

const FlowCells::Word* FlowCells::seen(int b) const {
  return seen_.data() + as_size(std::clamp(b, 0, geometry_.b_scans - 1)) * as_size(mark_slab_);
}

void FlowCells::update(int b, std::span<const std::uint8_t> counts) noexcept {
  const auto depths = as_size(geometry_.depths);
  std::uint8_t* column = counts_.data() + as_size(b) * as_size(slab_bytes());
  Word* slab = seen_.data() + as_size(b) * as_size(mark_slab_);
  Sides sides;
  find_seen(counts.first(depths), sides[0]);
  for (int first = 0; first <= geometry_.a_scans; first += cells_of_word) {
    for (int i = 0; i < cells_of_word; ++i) {
      Seen& seen = sides[as_size(i + 1)];
      if (first + i >= geometry_.a_scans) { // the last one's other side, or no cell's
        std::copy_n(sides[as_size(i)].begin(), mark_row_, seen.begin());
        continue;
      }
      const auto a_scan = counts.subspan(as_size(first + i) * depths, depths);
      find_seen(a_scan, seen);
      std::ranges::copy(a_scan, column);
      column[depths] = a_scan.back();
      column += column_bytes_;
    }
    find_seen_between(sides, mark_row_, std::min(geometry_.a_scans + 1 - first, cells_of_word),
                      slab);
    slab += mark_row_;
    std::copy_n(sides.back().begin(), mark_row_, sides.front().begin());
  }
}

void FlowCells::mark(int row) noexcept {
  const Word* before = seen(row - 1);
  const Word* after = seen(row);
  auto* to = reinterpret_cast<Word*>(marks_.data()) + as_size(row) * as_size(mark_slab_);
  for (std::size_t i = 0; i < as_size(mark_slab_); ++i)
    to[i] = before[i] | after[i];
}

} // namespace octascope::ui
