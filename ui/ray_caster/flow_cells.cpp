#include "ui/ray_caster/flow_cells.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include "ui/ray_caster/cell_volume.h"
#include "ui/transfer/flow_look.h"

namespace octascope::ui {

namespace {

constexpr int bins_of_byte = 8;
constexpr int bytes_of_word = 4; // neighbouring cells along the fast axis
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

void find_seen(std::span<const std::uint8_t> counts, Seen& seen) {
  const std::size_t whole = counts.size() / bins_of_byte;
  for (std::size_t i = 0; i < whole; ++i) {
    std::uint64_t eight = 0;
    std::memcpy(&eight, counts.data() + i * bins_of_byte, sizeof eight);
    seen[i] = seen_of(eight);
  }
  std::uint64_t rest = 0;
  std::memcpy(&rest, counts.data() + whole * bins_of_byte, counts.size() % bins_of_byte);
  seen[whole] = seen_of(rest);
}

// Of the cells between two A-scans: bytes of so many words.
void find_seen_between(const Seen& first, const Seen& second, int words, std::uint8_t* to) {
  unsigned here = first[0] | second[0];
  for (std::size_t i = 0; i < as_size(words); ++i) {
    const unsigned below = i + 1 < as_size(words) ? first[i + 1] | second[i + 1] : 0U;
    to[i * bytes_of_word] = static_cast<std::uint8_t>(here | (here >> 1U) | (below << 7U));
    here = below;
  }
}

} // namespace

FlowCells::FlowCells(const pipeline::VolumeGeometry& geometry)
    : geometry_{geometry}, column_bytes_{a_scan_stride(geometry)}, mark_row_{geometry.depths /
                                                                                 bins_of_byte +
                                                                             1},
      mark_slab_{mark_row_ * (geometry.a_scans / bytes_of_word + 1)},
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
  const int last = geometry_.a_scans - 1;
  std::uint8_t* column = counts_.data() + as_size(b) * as_size(slab_bytes());
  auto* const slab =
      reinterpret_cast<std::uint8_t*>(seen_.data() + as_size(b) * as_size(mark_slab_));
  std::array<Seen, 2> seen; // of the A-scans on either side of a cell
  find_seen(counts.first(depths), seen[1]);
  for (int a = 0; a <= last + 1; ++a) {
    const auto here = as_size(a % 2);
    if (a <= last) {
      const auto a_scan = counts.subspan(as_size(a) * depths, depths);
      find_seen(a_scan, seen[here]);
      std::ranges::copy(a_scan, column);
      column[depths] = a_scan.back();
      column += column_bytes_;
    }
    find_seen_between(seen[1 - here], seen[a <= last ? here : 1 - here], mark_row_,
                      slab + as_size(a / bytes_of_word * mark_row_) * bytes_of_word +
                          a % bytes_of_word);
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
