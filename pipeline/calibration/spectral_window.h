// The window that shapes the spectrum, and with it the axial point spread and its side lobes.
#pragma once

#include <cstdint>
#include <vector>

namespace octascope::pipeline {

enum class SpectralWindow : std::uint8_t {
  hann,
  hamming,
  blackman,
  gaussian, // standard deviation 0.4 of the half width
  tukey,    // a quarter of the width tapers at either end
  flat,
};

// Symmetric: w[m] = w[samples−1−m], highest value 1 (between the samples when their number is
// even). Not normalised to any sum: the level of a reflector depends on the window.
std::vector<double> make_spectral_window(SpectralWindow kind, int samples);

} // namespace octascope::pipeline
