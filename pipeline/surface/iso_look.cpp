#include "pipeline/surface/iso_look.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "pipeline/threads/cpu_clones.h"

namespace octascope::pipeline {

namespace {

// Metal is a thin line in a surface that its side lobes make, most of it above where they end: it is
// looked for along the depth, a little inside.
constexpr float inside_mm = 0.06F;
constexpr float above_mm = 0.4F;
constexpr float below_mm = 0.2F;

OCTASCOPE_CPU_CLONES
std::uint8_t brightest_of(const std::uint8_t* levels, std::size_t count) {
  std::uint8_t brightest = 0;
  for (std::size_t i = 0; i < count; ++i)
    brightest = std::max(brightest, levels[i]);
  return brightest;
}

} // namespace

void IsoLook::keep(const IsoGrid& grid) {
  levels_.resize(grid.levels.size());
  std::ranges::transform(grid.levels, levels_.begin(), [](std::uint16_t level) {
    return static_cast<std::uint8_t>(level >> 8U);
  });
}

void IsoLook::tell(const IsoGrid& grid, const Cover& cover, IsoMesh& mesh) const {
  mesh.covers = !cover.empty();
  for (IsoVertex& vertex : mesh.vertices) {
    vertex.brightest = brightest_at(grid, vertex);
    vertex.cover = static_cast<std::uint8_t>(std::lround(255 * cover.share_at(vertex.position_mm)));
  }
}

// Along depth, in the columns around the place: between two of them metal is as bright as in them.
std::uint8_t IsoLook::brightest_at(const IsoGrid& grid, const IsoVertex& vertex) const {
  const auto sample = [&](std::size_t axis, float off_mm) {
    const float inside =
        vertex.position_mm[axis] - inside_mm / 32767 * static_cast<float>(vertex.normal[axis]);
    return (inside + off_mm - grid.first_mm[axis]) / grid.cell_mm[axis];
  };
  const auto index = [](float at, int count) {
    return static_cast<std::size_t>(std::clamp(static_cast<int>(at), 0, count - 1));
  };
  const auto around = [&](std::size_t axis, int count) {
    const float at = std::floor(sample(axis, 0));
    return std::array{index(at, count), index(at + 1, count)};
  };
  const auto depths = static_cast<std::size_t>(grid.depths);
  const std::size_t first = index(sample(0, -above_mm) + 0.5F, grid.depths);
  const std::size_t last = index(sample(0, below_mm) + 0.5F, grid.depths);
  std::uint8_t brightest = 0;
  for (const std::size_t b : around(2, grid.b_scans))
    for (const std::size_t a : around(1, grid.a_scans)) {
      const std::size_t column = (b * static_cast<std::size_t>(grid.a_scans) + a) * depths;
      brightest =
          std::max(brightest, brightest_of(levels_.data() + column + first, last - first + 1));
    }
  return brightest;
}

} // namespace octascope::pipeline
