// The spectral window, which determines the axial point spread function and its side lobes.
#pragma once

#include <cstdint>
#include <vector>

namespace octascope::pipeline {

enum class SpectralWindow : std::uint8_t {
  hann,
  hamming,
  blackman,
  gaussian, // standard deviation 0.4 of the half width
  tukey,    // a quarter of the width tapers at each end
  flat,
};

// Symmetric: w[m] = w[samples−1−m], with maximum 1 (between the two middle samples if their number
// is even). Not normalised: the level of a reflector depends on the window.
std::vector<double> make_spectral_window(SpectralWindow kind, int samples);

} // namespace octascope::pipeline
