// What lights the technique "shaded": where the surfaces of a smoothed volume face, and how much
// tissue is around each place. Speckle has no part in it: its slopes are those of single voxels.
//
// Sources: M. Levoy, "Display of surfaces from volume data", IEEE CG&A 8 (1988): normals from
// gradients. F. Hernell, P. Ljung, A. Ynnerman, "Local ambient occlusion in direct volume rendering", IEEE TVCG 16
// (2010): places with much tissue around them get less light. Smoothing by the à-trous spline of
// J.-L. Starck, F. Murtagh, "Astronomical image and data analysis" (2006).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "pipeline/volume/volume.h"
#include "ui/view/window.h"

namespace octascope::ui {

// Threads: bound to one. Allocates when the geometry changes.
class LightVolume {
public:
  // Averages the levels into cells of about a 128th of the box's longest edge.
  void show(const pipeline::Volume& volume);

  // Makes the texels for a display window, unless they are there.
  void prepare(const WindowRamp& window);

  bool empty() const { return levels_.empty(); }

  struct Counts {
    int depth = 0;
    int a = 0;
    int b = 0;
    std::size_t all() const;
    bool operator==(const Counts&) const = default;
  };
  const Counts& counts() const { return counts_; }

  // [b][a][depth]. Bytes from the lowest: the slope of the density along depth, fast and slow axis,
  // 128 is none (slope_of()); the density of the surroundings, 255 is the window's top.
  std::span<const std::uint32_t> texels() const { return texels_; }
  // Counts their changes.
  std::uint64_t version() const { return version_; }

  // From a position in cells of the ray caster (ui/ray_caster/ray_geometry.h) to texels, whose
  // middles are at whole numbers.
  const glm::vec3& texel_scale() const { return scale_; }
  const glm::vec3& texel_offset() const { return offset_; }

private:
  using Densities = std::vector<float>;
  enum Axis : std::uint8_t { depth, fast, slow };

  void resize(const pipeline::VolumeGeometry& geometry);
  void average(const pipeline::Volume& volume, int b);
  void smooth(Axis axis, int stride);
  void write_slopes();
  void write_surroundings();

  pipeline::VolumeGeometry geometry_;
  Counts counts_;
  std::array<int, 3> voxels_{1, 1, 1}; // of a cell, by axis
  std::array<float, 3> mm_{};          // of a cell
  float unit_mm_ = 1;                  // over which slopes are counted
  glm::vec3 scale_{1};
  glm::vec3 offset_{0};
  Densities levels_; // means of the cells
  Densities density_;
  Densities spare_;
  std::vector<std::uint32_t> sums_; // of some A-scans
  std::vector<std::uint32_t> texels_;
  WindowRamp window_{};
  bool current_ = false;
  std::uint64_t version_ = 0;
};

// The lamp and what it lights, for the processor's rays and the shader's.
inline constexpr float ambient_light = 0.2F;
inline constexpr float level_light = 0.75F; // where there is no slope, and so no surface
inline constexpr float weak_slope = 0.08F;  // of a texel's 1: below it there is no surface
inline constexpr float open_light = 1.35F;  // less the density around a place: its share of light
inline constexpr float least_open = 0.5F;
// What reflects strongly, as metal does, keeps its light whichever way it faces: from the one brightness
// on, and all of it at the other.
inline constexpr float gleam_from = 0.6F;
inline constexpr float gleam_to = 0.85F;
inline constexpr float least_power = 1e-35F; // of a sample's weight: what divides is not 0

} // namespace octascope::ui
