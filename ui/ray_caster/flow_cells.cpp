#include "ui/ray_caster/flow_cells.h"

#include <algorithm>
#include <cstring>

#include "ui/transfer/flow_look.h"

namespace octascope::ui {

namespace {

constexpr int bins_of_word = 8;
constexpr int cells_of_word = 4; // along the fast axis
static_assert(first_seen_flow == pipeline::first_marked_flow);

std::size_t as_size(std::int32_t value) {
  return static_cast<std::size_t>(value);
}

// An odd number of cache lines (cell_volume.cpp).
std::int32_t a_scan_stride(const pipeline::VolumeGeometry& g) {
  return 64 * (((g.depths + 1 + 63) / 64) | 1);
}

// A kernel takes four bytes of each A-scan, of which it needs two.
constexpr std::size_t loaded_beyond = 2;

} // namespace

FlowCells::FlowCells(const pipeline::VolumeGeometry& geometry)
    : geometry_{geometry}, column_bytes_{a_scan_stride(geometry)}, mark_row_{geometry.depths /
                                                                                 bins_of_word +
                                                                             1},
      mark_slab_{mark_row_ * (geometry.a_scans / cells_of_word + 1)},
      counts_(as_size(slab_bytes()) * as_size(geometry.b_scans) + loaded_beyond),
      marks_(as_size(mark_slab_) * (as_size(geometry.b_scans) + 1) * sizeof(std::uint32_t)) {}

const std::uint32_t* FlowCells::marks() const {
  return reinterpret_cast<const std::uint32_t*>(marks_.data());
}

std::uint32_t* FlowCells::marks_of(int row) {
  return reinterpret_cast<std::uint32_t*>(marks_.data()) + as_size(row) * as_size(mark_slab_);
}

// The counts at the corners of a row's cells from that word to before that one.
void FlowCells::copy(int b, int word_row, int from, int to,
                     std::span<const std::uint8_t> counts) noexcept {
  const int depths = geometry_.depths;
  const int first_bin = from * bins_of_word;
  const int bins = std::min(to * bins_of_word + 1, depths) - first_bin;
  const int first_a = std::max(word_row * cells_of_word - 1, 0);
  const int last_a = std::min((word_row + 1) * cells_of_word - 1, geometry_.a_scans - 1);
  for (int a = first_a; a <= last_a; ++a) {
    std::uint8_t* const column =
        counts_.data() + as_size(b) * as_size(slab_bytes()) + as_size(a) * as_size(column_bytes_);
    const auto a_scan = counts.subspan(as_size(a) * as_size(depths), as_size(depths));
    if (bins > 0)
      std::memcpy(column + first_bin, a_scan.data() + first_bin, as_size(bins));
    if (to == mark_row_)
      column[depths] = a_scan.back();
  }
}

void FlowCells::take(int b, std::span<const std::uint8_t> counts,
                     const pipeline::FlowMarks& marks) noexcept {
  const std::uint32_t* const before = marks.of(std::max(b - 1, 0)).data();
  const std::uint32_t* const here = marks.of(b).data();
  const std::uint32_t* const after = marks.of(std::min(b + 1, geometry_.b_scans - 1)).data();
  std::uint32_t* const to = marks_of(b);
  for (int i = 0; i < mark_slab_; ++i)
    to[i] = before[i] | here[i];
  if (b == geometry_.b_scans - 1)
    std::copy_n(here, mark_slab_, marks_of(b + 1));
  for (int word_row = 0, at = 0; at < mark_slab_; ++word_row, at += mark_row_) {
    const auto flows = [&](int word) { return (to[at + word] | after[at + word]) != 0; };
    for (int word = 0; word < mark_row_; ++word) {
      if (!flows(word))
        continue;
      const int from = word;
      while (word < mark_row_ && flows(word))
        ++word;
      copy(b, word_row, from, word, counts);
    }
  }
}

} // namespace octascope::ui
