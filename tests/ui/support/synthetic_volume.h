// Volumes with known contents.
#pragma once

#include "pipeline/volume/volume.h"
#include "ui/hud/window_histogram.h"

namespace octascope::tests {

// Every voxel of every good B-scan has that count.
pipeline::Volume uniform_volume(const pipeline::VolumeGeometry& geometry, std::uint8_t count);

// A ball of 200 counts in the middle of n voxels each way, 25 µm apart, whose surface is a ramp of two
// voxels.
pipeline::Volume ball_volume(int n, double radius_mm);

// Tissue: three layers under a wavy surface, vessels (bright walls, dark lumen) within, a bright
// sphere on it and the noise floor above, with speckle from a fixed seed. The same on every
// machine.
pipeline::Volume tissue_volume(const pipeline::VolumeGeometry& geometry);

// The same, perfused: its vessels and finer ones below them flow, the rest of the tissue is static, and
// nothing is told above it.
pipeline::Volume perfused_volume(const pipeline::VolumeGeometry& geometry);

// Adds what flows: three tubes through the volume, of which `phase` says how they bend, with walls of
// two voxels, static tissue around them, and one B-scan that is left out.
void add_tubes(pipeline::Volume& volume, float phase = 0);

// How often its levels occur.
ui::LevelShares level_shares(const pipeline::Volume& volume);

// 300 × 80 × 512 as the instrument's, and a smaller one of the same extents for quick tests.
inline constexpr pipeline::VolumeGeometry full_geometry{512, 300, 80, 3.5, 10, 37.5, 1.38};
inline constexpr pipeline::VolumeGeometry small_geometry{128, 100, 40, 14, 30, 75, 1.38};

} // namespace octascope::tests
