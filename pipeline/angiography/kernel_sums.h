// The plain loops of angiography: products of two lines of bins, their phase, their sums over the
// kernel. Compiled for each generation of processors (pipeline/threads/cpu_clones.h).
//
// Lines are pointers to `depths` values, or to those from `begin` to `end`; outputs overlap no input.
#pragma once

#include <array>
#include <complex>

#include "pipeline/volume/packed_bin.h"

namespace octascope::pipeline {

// The kernel: 3 A-scans by 5 depths. At the borders of a B-scan it has what there is of it.
inline constexpr int kernel_a_scans = 3;
inline constexpr int kernel_depths = 5;

// Bins as real and imaginary parts.
void split_parts(const PackedBin* line, int begin, int end, float* real, float* imaginary) noexcept;

// The same of Σ_i taps[i]·line[z + i].
void interpolate(const PackedBin* line, const std::array<std::complex<float>, 6>& taps, int begin,
                 int end, float* real, float* imaginary) noexcept;

// real[s] + i·imaginary[s] += Σ_z first[z]·conj(second[z + s − 16]). Lines are `depths` real parts,
// then as many imaginary ones; depths > 32.
void correlate_lags(const float* first, const float* second, int depths,
                    std::array<float, 32>& real, std::array<float, 32>& imaginary) noexcept;

float sum_of_squares(const float* values, int count) noexcept;

// Asks for a line that is needed soon: bins come from memory, and what processors fetch ahead by
// themselves ends with a page, as a line may do.
void fetch_line(const PackedBin* line, int depths) noexcept;

// What the kernel sums of each pair of repeats.
struct PairSums {
  float* like;  // complex bins: real part of Y1·conj(Y2); intensities: I1·I2
  float* other; // complex bins: imaginary part; intensities: (I1 + I2)/2
  float* power; // complex bins: (|Y1|² + |Y2|²)/2; intensities: (I1² + I2²)/2
};

struct Parts {
  const float* real;
  const float* imaginary;
};

// Adds one pair of lines. The phase that the whole A-scan turned by between the two, the argument of
// Σ_z Y1·conj(Y2), is taken off. `scratch` has room for two lines.
void add_complex_pair(const Parts& first, const Parts& second, int begin, int end,
                      const PairSums& sums, float* scratch) noexcept;
void add_intensity_pair(const Parts& first, const Parts& second, int begin, int end,
                        const PairSums& sums) noexcept;

// sum[z] = Σ_line lines[line][z]
void add_lines(const float* const* lines, int count, int depths, float* sum) noexcept;

// What the kernel says of each voxel of a line; `sums` reach two values beyond either end.
// decorrelation: 1 − |like + i·other| / power of complex bins, 1 − like / power of intensities;
// 1 where there is no power. Means are sums divided by the kernel's pairs of voxels, whose
// reciprocal is `scale`[z].
// level: mean power of complex bins, mean intensity of intensities.
void finish_complex(const PairSums& sums, const float* scale, int depths, float* decorrelation,
                    float* level) noexcept;
void finish_intensity(const PairSums& sums, const float* scale, int depths, float* decorrelation,
                      float* level, float* second_moment) noexcept;

} // namespace octascope::pipeline
