#include "pipeline/surface/iso_grid.h"

#include <algorithm>
#include <cmath>

#include "pipeline/threads/cpu_clones.h"

namespace octascope::pipeline {

namespace {

constexpr double cell_share = 0.6; // of the longest voxel edge
constexpr double least_cell_um = 20;
constexpr std::size_t most_samples = std::size_t{4} << 20U;
constexpr int most_factor = 64; // of all axes together 2^18 voxels: their sum fits 32 bits

OCTASCOPE_CPU_CLONES
void add_column(const std::uint8_t* __restrict levels, std::size_t depths,
                std::uint32_t* __restrict sums) {
  for (std::size_t z = 0; z < depths; ++z)
    sums[z] += levels[z];
}

// What the instrument's own scan needs, in one go.
OCTASCOPE_CPU_CLONES
void average_pair_by_four(const std::uint8_t* __restrict first,
                          const std::uint8_t* __restrict second, std::size_t count,
                          std::uint16_t* __restrict out) {
  for (std::size_t i = 0; i < count; ++i) {
    unsigned sum = 0;
    for (std::size_t k = 0; k < 4; ++k)
      sum += first[4 * i + k] + second[4 * i + k];
    out[i] = static_cast<std::uint16_t>(sum * 32); // 256 / 8
  }
}

OCTASCOPE_CPU_CLONES
void average_sums(const std::uint32_t* __restrict sums, std::size_t factor, std::size_t count,
                  float scale, std::uint16_t* __restrict out) {
  for (std::size_t i = 0; i < count; ++i) {
    std::uint32_t sum = 0;
    for (std::size_t k = 0; k < factor; ++k)
      sum += sums[factor * i + k];
    out[i] = static_cast<std::uint16_t>(static_cast<float>(sum) * scale + 0.5F);
  }
}

OCTASCOPE_CPU_CLONES
void binomial(const std::uint16_t* __restrict before, const std::uint16_t* __restrict here,
              const std::uint16_t* __restrict after, std::size_t count,
              std::uint16_t* __restrict out) {
  for (std::size_t i = 0; i < count; ++i)
    out[i] = static_cast<std::uint16_t>((before[i] + 2U * here[i] + after[i] + 2U) >> 2U);
}

OCTASCOPE_CPU_CLONES
void to_counts(const std::uint16_t* __restrict levels, std::size_t count,
               std::uint8_t* __restrict out) {
  for (std::size_t i = 0; i < count; ++i)
    out[i] = static_cast<std::uint8_t>(levels[i] >> 8U);
}

} // namespace

std::array<int, 3> iso_factors(const VolumeGeometry& g, int first_depth) {
  const std::array spacings{g.depth_spacing_um, g.a_spacing_um, g.b_spacing_um};
  const std::array counts{g.depths - first_depth, g.a_scans, g.b_scans};
  const double target = std::max(cell_share * *std::ranges::max_element(spacings), least_cell_um);
  std::array<int, 3> factors{1, 1, 1};
  // Of an axis, two samples at least have to be left.
  const auto may_double = [&](std::size_t i) {
    return factors[i] < most_factor && counts[i] >= 4 * factors[i];
  };
  for (std::size_t i = 0; i < 3; ++i)
    while (2 * factors[i] * spacings[i] <= target && may_double(i))
      factors[i] *= 2;
  const auto samples = [&] {
    std::size_t all = 1;
    for (std::size_t i = 0; i < 3; ++i)
      all *= static_cast<std::size_t>(std::max(counts[i], 0) / factors[i]);
    return all;
  };
  while (samples() > most_samples) { // the finest cells give way
    std::size_t finest = 3;
    for (std::size_t i = 0; i < 3; ++i)
      if (may_double(i) &&
          (finest == 3 || factors[i] * spacings[i] < factors[finest] * spacings[finest]))
        finest = i;
    if (finest == 3)
      break;
    factors[finest] *= 2;
  }
  return factors;
}

namespace {

void set_geometry(const VolumeGeometry& g, const std::array<int, 3>& factors, int first_depth,
                  IsoGrid& grid) {
  const std::array spacings{g.depth_spacing_um, g.a_spacing_um, g.b_spacing_um};
  grid.depths = (g.depths - first_depth) / factors[0];
  grid.a_scans = g.a_scans / factors[1];
  grid.b_scans = g.b_scans / factors[2];
  grid.voxels = factors[0] * factors[1] * factors[2];
  grid.extents_mm = {static_cast<float>(g.depth_mm()), static_cast<float>(g.a_mm()),
                     static_cast<float>(g.b_mm())};
  for (std::size_t i = 0; i < 3; ++i) {
    grid.cell_mm[i] = static_cast<float>(factors[i] * spacings[i] * 1e-3);
    grid.first_mm[i] = grid.cell_mm[i] / 2;
  }
  grid.first_mm[0] += static_cast<float>(first_depth * spacings[0] * 1e-3);
  grid.levels.resize(grid.slice() * static_cast<std::size_t>(grid.b_scans));
  grid.present.resize(static_cast<std::size_t>(grid.b_scans));
}

} // namespace

void IsoGridMaker::make(const Volume& volume, int first_depth, IsoGrid& grid) {
  const VolumeGeometry& g = volume.geometry;
  first_depth = std::min(first_depth, g.depths);
  const std::array<int, 3> factors = iso_factors(g, first_depth);
  set_geometry(g, factors, first_depth, grid);
  sums_.resize(static_cast<std::size_t>(g.depths));
  const auto pitch = static_cast<std::size_t>(g.depths);
  const auto depths = static_cast<std::size_t>(grid.depths);
  const auto fz = static_cast<std::size_t>(factors[0]);
  const auto fa = static_cast<std::size_t>(factors[1]);
  const auto fb = static_cast<std::size_t>(factors[2]);
  const float scale = 256.0F / static_cast<float>(fz * fa * fb);
  std::uint16_t* out = grid.levels.data();
  for (std::size_t b = 0; b < static_cast<std::size_t>(grid.b_scans); ++b) {
    const auto own = std::span{volume.b_scan_states}.subspan(b * fb, fb);
    grid.present[b] = std::ranges::find(own, BScanState::missing) == own.end() ? 1 : 0;
    for (std::size_t a = 0; a < static_cast<std::size_t>(grid.a_scans); ++a, out += depths) {
      const std::uint8_t* column = volume.levels.data() + static_cast<std::size_t>(first_depth) +
                                   b * fb * g.b_scan_voxels() + a * fa * pitch;
      if (fz == 4 && fa == 2 && fb == 1) {
        average_pair_by_four(column, column + pitch, depths, out);
        continue;
      }
      std::ranges::fill(sums_, 0U);
      for (std::size_t k = 0; k < fb; ++k)
        for (std::size_t i = 0; i < fa; ++i)
          add_column(column + k * g.b_scan_voxels() + i * pitch, depths * fz, sums_.data());
      average_sums(sums_.data(), fz, depths, scale, out);
    }
  }
}

std::array<int, 3> IsoSmoother::passes_for(const IsoGrid& grid) {
  constexpr float sigma_share = 0.7F;
  constexpr float least_sigma_mm = 0.025F;
  constexpr int most_passes = 4;
  const float sigma =
      std::max(sigma_share * *std::ranges::max_element(grid.cell_mm), least_sigma_mm);
  std::array<int, 3> passes{};
  for (std::size_t i = 0; i < 3; ++i) { // each adds half a cell's square to the variance
    const float cells = sigma / grid.cell_mm[i];
    passes[i] = std::clamp(static_cast<int>(std::lround(2 * cells * cells)), 1, most_passes);
  }
  return passes;
}

void IsoSmoother::smooth_along(int axis, IsoGrid& grid) {
  const auto depths = static_cast<std::size_t>(grid.depths);
  const auto a_scans = static_cast<std::size_t>(grid.a_scans);
  const auto b_scans = static_cast<std::size_t>(grid.b_scans);
  if (axis == 0) {
    before_.resize(std::max(before_.size(), depths + 2));
    for (std::size_t column = 0; column < a_scans * b_scans; ++column) {
      std::uint16_t* at = grid.levels.data() + column * depths;
      std::copy_n(at, depths, before_.data() + 1); // the ends repeat themselves
      before_[0] = before_[1];
      before_[depths + 1] = before_[depths];
      binomial(before_.data(), before_.data() + 1, before_.data() + 2, depths, at);
    }
    return;
  }
  // Along the other axes, rows of `length` samples are smoothed with the rows before and after.
  const std::size_t length = axis == 1 ? depths : grid.slice();
  const std::size_t rows = axis == 1 ? a_scans : b_scans;
  const std::size_t blocks = axis == 1 ? b_scans : 1;
  before_.resize(std::max(before_.size(), 2 * length));
  const auto present = [&](std::size_t row) { return axis == 1 || grid.present[row] != 0; };
  for (std::size_t block = 0; block < blocks; ++block) {
    std::uint16_t* first = grid.levels.data() + block * rows * length;
    std::uint16_t* last_row = before_.data(); // as it was before it was smoothed
    std::uint16_t* own = before_.data() + length;
    for (std::size_t row = 0; row < rows; ++row) {
      std::uint16_t* at = first + row * length;
      std::copy_n(at, length, own);
      const bool before = row > 0 && present(row - 1);
      const bool after = row + 1 < rows && present(row + 1);
      if (present(row))
        binomial(before ? last_row : own, own, after ? at + length : own, length, at);
      std::swap(last_row, own);
    }
  }
}

void update_occupancy(const IsoGrid& grid, Occupancy& occupancy,
                      std::vector<std::uint8_t>& counts) {
  const VolumeGeometry geometry{grid.depths, grid.a_scans, grid.b_scans, 1, 1, 1};
  if (occupancy.geometry() != geometry)
    occupancy = Occupancy{geometry, 0};
  counts.resize(grid.slice());
  for (int b = 0; b < grid.b_scans; ++b) {
    to_counts(grid.slice(b).data(), counts.size(), counts.data());
    occupancy.update(b, counts);
  }
}

} // namespace octascope::pipeline
