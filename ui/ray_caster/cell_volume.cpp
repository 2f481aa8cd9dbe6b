#include "ui/ray_caster/cell_volume.h"

#include <algorithm>
#include <limits>

#include "pipeline/threads/cpu_clones.h"

namespace octascope::ui {

namespace {

OCTASCOPE_CPU_CLONES
void interleave(const std::uint8_t* first, const std::uint8_t* second, std::size_t count,
                std::uint8_t* __restrict pairs) {
  for (std::size_t i = 0; i < count; ++i) {
    pairs[2 * i] = first[i];
    pairs[2 * i + 1] = second[i];
  }
}

// An odd number of cache lines: at a power of two the columns would share few cache sets.
std::int64_t column_size(const pipeline::VolumeGeometry& g) {
  const std::int64_t lines = (2 * (std::int64_t{g.depths} + 1) + 63) / 64;
  return 64 * (lines | 1);
}

std::int64_t row_size(const pipeline::VolumeGeometry& g) {
  return column_size(g) * (std::int64_t{g.a_scans} + 1);
}

} // namespace

bool CellVolume::fits(const pipeline::VolumeGeometry& g) {
  return g.depths >= 1 && g.a_scans >= 1 && g.b_scans >= 1 && g.depths <= longest &&
         g.a_scans <= longest && g.b_scans <= longest &&
         row_size(g) * (std::int64_t{g.b_scans} + 2) <
             std::int64_t{std::numeric_limits<std::int32_t>::max()};
}

CellVolume::CellVolume(const pipeline::VolumeGeometry& geometry)
    : geometry_{geometry}, column_bytes_{static_cast<std::int32_t>(column_size(geometry))},
      row_bytes_{static_cast<std::int32_t>(row_size(geometry))},
      cells_(static_cast<std::size_t>(row_bytes_) *
             (static_cast<std::size_t>(geometry.b_scans) + 2)) {}

void CellVolume::update(int b, std::span<const std::uint8_t> levels) noexcept {
  fill_row(b + 1, levels);
  if (b == 0)
    fill_row(0, levels);
  if (b == geometry_.b_scans - 1)
    fill_row(b + 2, levels);
}

void CellVolume::fill_row(int row, std::span<const std::uint8_t> levels) noexcept {
  const auto depths = static_cast<std::size_t>(geometry_.depths);
  const auto a_scan = [&](int a) {
    return levels.data() +
           static_cast<std::size_t>(std::clamp(a, 0, geometry_.a_scans - 1)) * depths;
  };
  std::uint8_t* column =
      cells_.data() + static_cast<std::size_t>(row) * static_cast<std::size_t>(row_bytes_);
  for (int cell = 0; cell <= geometry_.a_scans; ++cell) {
    interleave(a_scan(cell - 1), a_scan(cell), depths, column);
    std::copy_n(column + 2 * depths - 2, 2, column + 2 * depths); // below the last bin, the same
    column += column_bytes_;
  }
}

} // namespace octascope::ui
