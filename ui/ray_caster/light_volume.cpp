#include "ui/ray_caster/light_volume.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "pipeline/threads/cpu_clones.h"

namespace octascope::ui {

namespace {

constexpr float cells_along = 128; // the box's longest edge
constexpr float slope_gain = 2.5F; // of a sharp surface, to about 1

OCTASCOPE_CPU_CLONES
void add_levels(const std::uint8_t* from, std::uint32_t* __restrict to, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i)
    to[i] += from[i];
}

OCTASCOPE_CPU_CLONES
void spline(const float* before, const float* here, const float* after, float* __restrict to,
            std::size_t count) {
  for (std::size_t i = 0; i < count; ++i)
    to[i] = 0.25F * (before[i] + after[i]) + 0.5F * here[i];
}

OCTASCOPE_CPU_CLONES
void window_levels(const float* from, float scale, float offset, float* __restrict to,
                   std::size_t count) {
  for (std::size_t i = 0; i < count; ++i)
    to[i] = std::min(std::max(from[i] * scale + offset, 0.0F), 1.0F);
}

std::uint32_t slope_byte(float slope) {
  return static_cast<std::uint32_t>(128.5F + 127 * std::clamp(slope, -1.0F, 1.0F));
}

} // namespace

std::size_t LightVolume::Counts::all() const {
  return static_cast<std::size_t>(depth) * static_cast<std::size_t>(a) *
         static_cast<std::size_t>(b);
}

void LightVolume::resize(const pipeline::VolumeGeometry& g) {
  if (g == geometry_ && !empty())
    return;
  geometry_ = g;
  const std::array spacing_mm{static_cast<float>(g.depth_spacing_um) * 1e-3F,
                              static_cast<float>(g.a_spacing_um) * 1e-3F,
                              static_cast<float>(g.b_spacing_um) * 1e-3F};
  const std::array voxels{g.depths, g.a_scans, g.b_scans};
  std::array<int, 3> cells{};
  unit_mm_ = 0;
  for (std::size_t axis = 0; axis < 3; ++axis)
    unit_mm_ = std::max(unit_mm_, spacing_mm[axis] * static_cast<float>(voxels[axis]));
  unit_mm_ /= cells_along;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const int in_unit = static_cast<int>(std::lround(unit_mm_ / spacing_mm[axis]));
    voxels_[axis] = std::clamp(in_unit, 1, voxels[axis]);
    cells[axis] = (voxels[axis] + voxels_[axis] - 1) / voxels_[axis];
    mm_[axis] = spacing_mm[axis] * static_cast<float>(voxels_[axis]);
    const auto count = static_cast<float>(voxels_[axis]);
    const auto of_axis = static_cast<glm::length_t>(axis);
    scale_[of_axis] = 1 / count;
    // The middle of voxel 0 is at 0 along the depth, at 1 along the others.
    offset_[of_axis] = -((axis > 0 ? 1.0F : 0.0F) + (count - 1) / 2) / count;
  }
  counts_ = {cells[0], cells[1], cells[2]};
  levels_.assign(counts_.all(), 0);
  density_.assign(counts_.all(), 0);
  spare_.assign(counts_.all(), 0);
  texels_.assign(counts_.all(), 0);
  sums_.assign(static_cast<std::size_t>(g.depths), 0);
}

void LightVolume::show(const pipeline::Volume& volume) {
  resize(volume.geometry);
  for (int b = 0; b < counts_.b; ++b)
    average(volume, b);
  current_ = false;
}

// The cells of one row of B-scans.
void LightVolume::average(const pipeline::Volume& volume, int b) {
  const auto depths = static_cast<std::size_t>(geometry_.depths);
  const auto in_cell = static_cast<std::size_t>(voxels_[depth]);
  const auto line = static_cast<std::size_t>(counts_.depth);
  float* to =
      levels_.data() + static_cast<std::size_t>(b) * line * static_cast<std::size_t>(counts_.a);
  const int last_b = std::min((b + 1) * voxels_[slow], geometry_.b_scans);
  for (int a = 0; a < counts_.a; ++a, to += line) {
    std::ranges::fill(sums_, 0U);
    const int last_a = std::min((a + 1) * voxels_[fast], geometry_.a_scans);
    for (int of_b = b * voxels_[slow]; of_b < last_b; ++of_b)
      for (int of_a = a * voxels_[fast]; of_a < last_a; ++of_a)
        add_levels(volume.b_scan(of_b).data() + static_cast<std::size_t>(of_a) * depths,
                   sums_.data(), depths);
    const int columns = (last_b - b * voxels_[slow]) * (last_a - a * voxels_[fast]);
    for (std::size_t cell = 0; cell < line; ++cell) {
      const std::size_t first = cell * in_cell;
      const std::size_t last = std::min(first + in_cell, depths);
      std::uint32_t sum = 0;
      for (std::size_t z = first; z < last; ++z)
        sum += sums_[z];
      to[cell] = static_cast<float>(sum) /
                 (static_cast<float>(columns) * static_cast<float>(last - first));
    }
  }
}

void LightVolume::prepare(const WindowRamp& window) {
  if (current_ && window.scale == window_.scale && window.offset == window_.offset)
    return;
  window_ = window;
  current_ = true;
  ++version_;
  window_levels(levels_.data(), window.scale / 255, window.offset, density_.data(),
                density_.size());
  for (const Axis axis : {depth, fast, slow})
    smooth(axis, 1);
  write_slopes();
  for (const int stride : {1, 2, 4})
    for (const Axis axis : {depth, fast, slow})
      if (static_cast<float>(stride) * mm_[axis] < 6 * unit_mm_)
        smooth(axis, stride);
  write_surroundings();
}

// Cells at the border have the same beyond it.
void LightVolume::smooth(Axis axis, int stride) {
  const auto line = static_cast<std::size_t>(counts_.depth);
  const std::size_t slab = line * static_cast<std::size_t>(counts_.a);
  const auto apart = static_cast<std::size_t>(stride);
  if (axis == depth) {
    for (std::size_t at = 0; at < density_.size(); at += line) {
      const float* from = density_.data() + at;
      float* to = spare_.data() + at;
      for (std::size_t z = 0; z < line; ++z)
        if (z < apart || z + apart >= line)
          to[z] = 0.5F * from[z] +
                  0.25F * (from[z < apart ? 0 : z - apart] + from[std::min(z + apart, line - 1)]);
      if (line > 2 * apart)
        spline(from, from + apart, from + 2 * apart, to + apart, line - 2 * apart);
    }
  } else {
    const std::size_t block = axis == fast ? line : slab;
    const std::size_t group = axis == fast ? slab : density_.size();
    const std::size_t blocks = group / block;
    for (std::size_t base = 0; base < density_.size(); base += group)
      for (std::size_t i = 0; i < blocks; ++i) {
        const std::size_t before = i < apart ? 0 : i - apart;
        const std::size_t after = std::min(i + apart, blocks - 1);
        spline(density_.data() + base + before * block, density_.data() + base + i * block,
               density_.data() + base + after * block, spare_.data() + base + i * block, block);
      }
  }
  std::swap(density_, spare_);
}

void LightVolume::write_slopes() {
  const auto line = static_cast<std::size_t>(counts_.depth);
  const std::size_t slab = line * static_cast<std::size_t>(counts_.a);
  const std::array<std::size_t, 3> stride{1, line, slab};
  const std::array counts{counts_.depth, counts_.a, counts_.b};
  std::array<float, 3> gain{};
  for (std::size_t axis = 0; axis < 3; ++axis)
    gain[axis] = slope_gain * unit_mm_ / (2 * mm_[axis]);
  std::size_t at = 0;
  std::array<int, 3> place{};
  for (place[slow] = 0; place[slow] < counts[slow]; ++place[slow])
    for (place[fast] = 0; place[fast] < counts[fast]; ++place[fast])
      for (place[depth] = 0; place[depth] < counts[depth]; ++place[depth], ++at) {
        std::uint32_t texel = 0;
        for (std::size_t axis = 0; axis < 3; ++axis) {
          const std::size_t more = place[axis] + 1 < counts[axis] ? at + stride[axis] : at;
          const std::size_t less = place[axis] > 0 ? at - stride[axis] : at;
          texel |= slope_byte((density_[more] - density_[less]) * gain[axis]) << (8 * axis);
        }
        texels_[at] = texel;
      }
}

void LightVolume::write_surroundings() {
  for (std::size_t i = 0; i < texels_.size(); ++i)
    texels_[i] |= static_cast<std::uint32_t>(255 * density_[i] + 0.5F) << 24U;
}

} // namespace octascope::ui
