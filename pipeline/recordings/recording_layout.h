// The names and types in a recording's file, for its writer and its reader; docs/RECORDINGS.md.
#pragma once

#include <array>
#include <cstdint>

#include "pipeline/recordings/hdf5/hdf5.h"
#include "pipeline/recordings/recording.h"

namespace octascope::pipeline::recording_layout {

inline constexpr const char* format_name = "octascope recording";
inline constexpr std::int64_t format_version = 1;

// Datasets; the first dimension of each is the volume.
inline constexpr const char* levels = "levels";               // [volume][b][a][z], counts
inline constexpr const char* b_scan_states = "b_scan_states"; // [volume][b], BScanState
inline constexpr const char* metadata = "ledger";             // [volume], RecordedVolume

// RecordedVolume, as it lies in memory, under the names that the file uses.
Hdf5Handle ledger_type();

// The dimensions of `levels` and `b_scan_states` for a number of volumes.
std::array<hsize_t, 4> levels_size(const VolumeGeometry& geometry, hsize_t volumes);
std::array<hsize_t, 2> states_size(const VolumeGeometry& geometry, hsize_t volumes);

} // namespace octascope::pipeline::recording_layout
