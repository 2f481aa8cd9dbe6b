// The inner loops of the reconstruction, each over one line (spectrum).
//
// No function here allocates, locks or knows about files. Every pointer is to `samples` values
// unless said otherwise; nothing outside them is read, so a line never sees its neighbour.
#pragma once

#include <cstdint>

namespace octascope::pipeline {

// counts >> right_shift − background → line. Returns the highest shifted count.
std::uint32_t load_line(const std::uint8_t* counts, const float* background, int right_shift,
                        int samples, float* line);
std::uint32_t load_line(const std::uint16_t* counts, const float* background, int right_shift,
                        int samples, float* line);
// Float lines have no full scale: returns 0.
std::uint32_t load_line(const float* counts, const float* background, int right_shift, int samples,
                        float* line);

// sum = the sum of (counts >> right_shift) over `lines` lines without gaps, at most 65536.
void sum_lines(const std::uint8_t* counts, int lines, int right_shift, int samples,
               std::uint32_t* sum);
void sum_lines(const std::uint16_t* counts, int lines, int right_shift, int samples,
               std::uint32_t* sum);
// Floats are summed in double precision.
void sum_lines(const float* counts, int lines, int right_shift, int samples, double* sum);

// sum += counts >> right_shift, unless one of them is at least `limit` after the shift. Says
// whether it was added.
bool add_line_below(const std::uint8_t* counts, std::uint32_t limit, int right_shift, int samples,
                    float* sum);
bool add_line_below(const std::uint16_t* counts, std::uint32_t limit, int right_shift, int samples,
                    float* sum);
// Floats have no full scale: always added.
bool add_line_below(const float* counts, std::uint32_t limit, int right_shift, int samples,
                    float* sum);

// Interpolated counts times the factor of each sample: window, dispersion phase and 1/N in one.
// `first`, `weights`: ResamplingTaps. `factors`: complex (re, im, re, im …) or real. Buffers and
// tables are padded to a multiple of 4 samples.
using ShapeLine = void (*)(const float* line, const std::int32_t* first, const float* weights,
                           const float* factors, int samples, float* shaped);

// taps_width 0, 4 or 8.
ShapeLine shape_line_kernel(int taps_width, bool complex_factors);

// |Y|² of `depths` complex bins as levels: in decibels, or as the 8-bit counts of level_scale.h.
void levels_db(const float* bins, int depths, float* levels);
void levels_u8(const float* bins, int depths, std::uint8_t* levels);

} // namespace octascope::pipeline
