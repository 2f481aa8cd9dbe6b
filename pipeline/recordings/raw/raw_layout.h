// The names and types in a file of raw spectra, for its writer and its reader; docs/RECORDINGS.md.
#pragma once

#include <array>
#include <cstdint>

#include "pipeline/recordings/hdf5/hdf5.h"
#include "pipeline/recordings/raw/raw_recording.h"

namespace octascope::pipeline::raw_layout {

inline constexpr const char* format_name = "octascope raw spectra";
inline constexpr std::int64_t format_version = 1;

// Datasets; the first dimension of each is the frame.
inline constexpr const char* spectra = "spectra"; // [frame][line][sample]
inline constexpr const char* frames = "frames";   // [frame], RawFrame
inline constexpr const char* backgrounds =
    "backgrounds"; // [frame][sample], RawFacts::has_backgrounds()

inline constexpr const char* calibration = "calibration"; // a group

// In the place of a refractive index that nobody said.
inline constexpr double medium_not_said = 0;

// RawFrame, as it lies in memory.
Hdf5Handle frame_type();

// Of a sample in the file; not to be closed.
hid_t sample_type(hal::SampleType type);

// The dimensions of `spectra` and `backgrounds` for a number of frames.
std::array<hsize_t, 3> spectra_size(const hal::LineFormat& format, hsize_t frames);
std::array<hsize_t, 2> backgrounds_size(const hal::LineFormat& format, hsize_t frames);

} // namespace octascope::pipeline::raw_layout
