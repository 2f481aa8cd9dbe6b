// What raw spectra look like, in numbers that a person at the instrument can act on.
#pragma once

#include <cstddef>
#include <span>

namespace octascope::pipeline {

struct SpectrumQuality {
  double saturated_share = 0; // of the lines: those with a sample at full scale
  double brightest = 0;       // highest count, as a share of full scale
  double dark_counts = 0;     // the level that one pixel in a hundred is below, of the mean line
  double contrast = 0;        // fringe amplitude over the light that carries it; noise adds some
};

// `lines` is [line][sample] in counts after the right shift, at least one line. The contrast is the
// mean over the lines, each √2·rms of what remove_slow_part() (fringe.h), twice, leaves of it over the mean
// light above the dark level, both where the light is at least half of the brightest.
SpectrumQuality judge_spectra(std::span<const double> lines, std::size_t samples,
                              double full_scale);

} // namespace octascope::pipeline
