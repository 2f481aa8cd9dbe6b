#include "ui/panels/projection.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace octascope::ui {

namespace {

// Of the slab, from where the brick with the surface begins: beyond the surface's glare, which is as
// wide as the spectrometer blurs it.
constexpr double slab_begin_mm = 0.1;
constexpr int slab_begin_voxels = 16;
constexpr double slab_mm = 0.4;
// Behind a gap, half of the least gap earlier: what is thin, as metal is, lies where the slope between
// bricks may already be deeper.
constexpr double ahead_mm = 0.15;

int voxels_of(double mm, const pipeline::VolumeGeometry& volume) {
  return static_cast<int>(std::lround(mm * 1e3 / volume.depth_spacing_um));
}

// Without a remainder, the loop is all vectors.
constexpr int lanes = 16;

std::uint8_t highest_of(const std::uint8_t* levels, int count) {
  std::uint8_t highest = 0;
  for (int i = 0; i < count; ++i)
    highest = std::max(highest, levels[i]);
  return highest;
}

int in_whole_lanes(int count) {
  return (count + lanes - 1) / lanes * lanes;
}

// A surface with nothing below it, as metal's with its shadow, is shown itself.
std::uint8_t level_in(const std::uint8_t* line, const TissueMap::Begin& begin,
                      const SlabFinder& finder, std::uint8_t tissue) {
  const Slab slab = finder.slab(begin);
  const std::uint8_t below = highest_of(line + slab.from, slab.count);
  return below >= tissue || begin.behind_gap
             ? below
             : std::max(below, highest_of(line + begin.depth, slab.from - begin.depth));
}

// At an edge, what either side's slab finds.
std::uint8_t mixed_level(const std::uint8_t* line, const TissueMap::Around& around,
                         const SlabFinder& finder, std::uint8_t tissue) {
  float sum = 0;
  for (std::size_t i = 0; i < around.begins.size(); ++i)
    sum += around.shares[i] * static_cast<float>(level_in(line, around.begins[i], finder, tissue));
  return static_cast<std::uint8_t>(sum + 0.5F);
}

struct Range {
  std::uint8_t lowest = 0;
  std::uint8_t highest = 1;
};

// Without 1 % at either end.
Range robust_range(const pipeline::Volume& volume, std::span<const std::uint8_t> levels) {
  std::array<std::uint32_t, 256> histogram{};
  const auto a_scans = static_cast<std::size_t>(volume.geometry.a_scans);
  std::uint32_t count = 0;
  for (std::size_t b = 0; b < volume.b_scan_states.size(); ++b) {
    if (!has_levels(volume.b_scan_states[b]))
      continue;
    for (const std::uint8_t level : levels.subspan(b * a_scans, a_scans))
      ++histogram[level];
    count += static_cast<std::uint32_t>(a_scans);
  }
  if (count == 0)
    return {};
  const auto value_at = [&](std::uint32_t rank) {
    std::size_t level = 0;
    for (std::uint32_t below = histogram[0]; below <= rank && level < 255;
         below += histogram[level])
      ++level;
    return static_cast<std::uint8_t>(level);
  };
  return {value_at(count / 100), value_at(count - 1 - count / 100)};
}

} // namespace

SlabFinder::SlabFinder(const pipeline::VolumeGeometry& geometry)
    : depths_{geometry.depths}, begin_{std::max(voxels_of(slab_begin_mm, geometry),
                                                slab_begin_voxels)},
      ahead_{voxels_of(ahead_mm, geometry)}, count_{std::clamp(
                                                 in_whole_lanes(voxels_of(slab_mm, geometry)), 1,
                                                 geometry.depths)} {}

Slab SlabFinder::slab(const TissueMap::Begin& begin) const {
  if (!begin.behind_gap)
    return {std::min(begin.depth + begin_, depths_ - count_), count_};
  // A little more of the gap is no loss.
  const int count = std::min(in_whole_lanes(depths_ - begin.depth + ahead_), depths_);
  return {depths_ - count, count};
}

void project_slab(const pipeline::Volume& volume, const TissueMap& tissue,
                  std::span<std::uint8_t> out, std::span<const std::uint8_t> wanted,
                  WorkTeam* team) {
  const pipeline::VolumeGeometry& geometry = volume.geometry;
  const SlabFinder finder{geometry};
  const auto a_scans = static_cast<std::size_t>(geometry.a_scans);
  run_pieces(team, static_cast<std::uint32_t>(geometry.b_scans), [&](std::uint32_t piece) {
    if (!wanted.empty() && wanted[piece] == 0)
      return;
    const int b = static_cast<int>(piece);
    const std::uint8_t* line = volume.b_scan(b).data();
    std::size_t i = piece * a_scans;
    for (int a = 0; a < geometry.a_scans; ++a, line += geometry.depths)
      out[i++] = tissue.even_at(b, a)
                     ? level_in(line, tissue.begin_of(b, a), finder, tissue.level())
                     : mixed_level(line, tissue.around(b, a), finder, tissue.level());
  });
}

void stretch_contrast(const pipeline::Volume& volume, std::span<std::uint8_t> levels) {
  const Range range = robust_range(volume, levels);
  const int extent = std::max(range.highest - range.lowest, 1);
  std::array<std::uint8_t, 256> greys;
  for (int level = 0; level < 256; ++level)
    greys[static_cast<std::size_t>(level)] = static_cast<std::uint8_t>(
        (std::clamp(level - range.lowest, 0, extent) * 255 + extent / 2) / extent);
  for (std::uint8_t& level : levels)
    level = greys[level];
}

} // namespace octascope::ui
