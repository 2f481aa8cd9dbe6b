// The shape of a volume.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace octascope::pipeline {

// Accepted refractive indices of the imaged medium, from air upwards.
inline constexpr double least_refractive_index = 1.0;
inline constexpr double most_refractive_index = 2.0;

// Spacings that nobody measured or said: a default stands in for them.
struct AssumedSpacings {
  bool depth = false;
  bool a_scans = false;
  bool b_scans = false;

  bool any() const { return depth || a_scans || b_scans; }
  // Those that are assumed, as "depth, A-scan, B-scan"; parse() takes it back.
  std::string words() const;
  static AssumedSpacings parse(std::string_view words);
  bool operator==(const AssumedSpacings&) const = default;
};

// Counts and spacings of the three axes: depth z, A-scan a (fast axis), B-scan b (slow axis).
struct VolumeGeometry {
  int depths = 0;
  int a_scans = 0;
  int b_scans = 0;
  double depth_spacing_um = 1; // of one depth bin, in the medium
  double a_spacing_um = 1;
  double b_spacing_um = 1;
  std::optional<double> refractive_index{}; // of that medium: 1 is air; empty: unknown
  AssumedSpacings assumed{};

  std::size_t b_scan_voxels() const {
    return static_cast<std::size_t>(depths) * static_cast<std::size_t>(a_scans);
  }
  std::size_t voxels() const { return b_scan_voxels() * static_cast<std::size_t>(b_scans); }

  // Physical extents of the whole volume.
  double depth_mm() const { return depths * depth_spacing_um * 1e-3; }
  double a_mm() const { return a_scans * a_spacing_um * 1e-3; }
  double b_mm() const { return b_scans * b_spacing_um * 1e-3; }

  bool operator==(const VolumeGeometry&) const = default;
};

// The background residue around zero delay, blurred over two bins by the spectral window, would
// cover the tissue like a bright lid. Volume renderings omit these bins; B-scans and exports show
// them.
inline constexpr int blank_depth_bins = 2;

} // namespace octascope::pipeline
