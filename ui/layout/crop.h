// The part of a volume that the flat pictures show.
#pragma once

#include "pipeline/volume/volume_geometry.h"

namespace octascope::ui {

// Shares of an extent of the volume, 0 to 1.
struct Section {
  float from = 0;
  float to = 1;

  float length() const { return to - from; }
  // Where in the section a share of the volume's extent lies: 0 and 1 are its ends.
  float place_of(float share) const { return (share - from) / length(); }
  bool operator==(const Section&) const = default;
};

struct Crop {
  Section depth{};
  Section a{}; // the fast axis
  Section b{}; // the slow axis

  // Extents of what is shown.
  double depth_mm(const pipeline::VolumeGeometry& volume) const {
    return volume.depth_mm() * static_cast<double>(depth.length());
  }
  double a_mm(const pipeline::VolumeGeometry& volume) const {
    return volume.a_mm() * static_cast<double>(a.length());
  }
  double b_mm(const pipeline::VolumeGeometry& volume) const {
    return volume.b_mm() * static_cast<double>(b.length());
  }
  bool operator==(const Crop&) const = default;
};

} // namespace octascope::ui
