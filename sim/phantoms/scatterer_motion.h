// How the field of scatterers that flow changes between the repeats of a B-scan.
//
// A group of scatterers that moves at (v_t across the beam, v_z along it) keeps, after a time τ, of
// its complex amplitude (of a share M of moving ones, the rest being still):
//
//   g(τ) = (1 − M) + M · exp(−(v_t·τ/w_t)² − (v_z·τ/w_z)²) · exp(i·q·v_z·τ),   q = 4π·n/λ
//
// after Lee, Wu, Jiang, Zhu, Boas, "Dynamic light scattering optical coherence tomography", Opt.
// Express 20, 22262 (2012), without its term of diffusion: cells here neither diffuse nor tumble, so
// that slow blood at a wall decorrelates less than in nature. w_t and w_z are the distances after
// which a point's amplitude correlates to 1/e with its own before. Within a resolution cell all
// scatterers move alike.
//
// Blood flows by Poiseuille's law, v(r) = v_axis·(1 − r²/R²), at the same shear at each wall, which
// is Murray's law for the radii (Murray, PNAS 12, 207 (1926)): v_axis = shear·R/2. At 1200/s an
// arteriole of 40 µm flows at 12 mm/s and a capillary of 7 µm at 2 mm/s.
//
// Light that crosses blood is scattered forwards as well and takes its fluctuation along: below a
// lumen of height h a share 1 − exp(−tail·h) of the tissue's light moves as the lumen's mean does. The
// artefact is described by Zhang et al., "Projection-resolved optical coherence tomographic
// angiography", Biomed. Opt. Express 7, 816 (2016); the exponential and its constant are ours.
#pragma once

#include <array>
#include <complex>
#include <cstddef>
#include <numbers>
#include <span>

#include "pipeline/scan/scan_plan.h"

namespace octascope::sim {

inline constexpr double lateral_cell_um = 8.5; // w_t: a spot of 10 µm, full width at half maximum
inline constexpr double axial_cell_um = 8.4;   // w_z: an axial resolution of 7 µm, likewise
inline constexpr double wall_shear_per_s = 1200;
inline constexpr double tail_per_mm = 4;
// q: a path's phase for a wavelength of 840 nm, in water.
inline constexpr double phase_rad_per_mm = 4 * std::numbers::pi * 1.35 / 0.84e-3;

// Scatterers' velocity, and their share of a depth bin's, 0 … 1.
struct ScattererMotion {
  float across_mm_per_s = 0; // v_t
  float along_mm_per_s = 0;  // v_z, downwards
  float share = 0;           // M
  bool operator==(const ScattererMotion&) const = default;
};

// g(τ); g(−τ) is its conjugate.
std::complex<double> field_correlation(const ScattererMotion& motion, double seconds);

inline constexpr std::size_t most_repeats = pipeline::ScanPlan::most_repeats;

// What the last of the repeats at `times_s` (1 to most_repeats) has of independent numbers, one for
// each repeat: with these, amplitudes correlate between repeats as g() says. Row by row the Cholesky
// factor of the matrix g(times[i] − times[j]).
std::array<std::complex<float>, most_repeats> repeat_weights(const ScattererMotion& motion,
                                                             std::span<const double> times_s);

} // namespace octascope::sim
