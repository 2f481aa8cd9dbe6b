// The spectrometer's forward model, fast: whole A-scans of tissue, a line in microseconds.
//
// Tissue is a complex amplitude in every depth bin, a surface a Reflector at any fraction of a bin.
// One inverse FFT sums their fringes on a grid uniform in k (shifted to the middle of the depth
// range, so that the grid oversamples it twice), and a Kaiser-Bessel kernel of 4 taps reads it at
// each pixel's position; the kernel's weight in depth is divided out beforehand (a non-uniform FFT
// of the second kind: Fessler and Sutton, IEEE Trans. Signal Process. 51, 2003). Envelope, gain and
// dispersion are folded into the taps. The error against the closed form is below 0.3 % of an
// amplitude.
#pragma once

#include <complex>
#include <memory>
#include <span>
#include <vector>

#include "sim/spectrometer/noise.h"
#include "sim/spectrometer/spectrometer.h"

namespace octascope::sim {

// Immutable once made: any number of threads may share one, each with its own Workspace. The
// constructor plans an FFT, and FFTW's planner is not thread-safe: make it where no other thread
// plans, that is during start-up.
class SpectrumSynthesis {
public:
  class Workspace {
  public:
    Workspace(Workspace&&) noexcept;
    Workspace& operator=(Workspace&&) noexcept;
    ~Workspace();

  private:
    friend class SpectrumSynthesis;
    struct Buffers;
    explicit Workspace(std::unique_ptr<Buffers> buffers);
    std::unique_ptr<Buffers> buffers_;
  };

  // Borrows nothing: copies the spectrometer's curves into tables.
  explicit SpectrumSynthesis(const Spectrometer& spectrometer);
  ~SpectrumSynthesis();
  SpectrumSynthesis(const SpectrumSynthesis&) = delete;
  SpectrumSynthesis& operator=(const SpectrumSynthesis&) = delete;

  Workspace make_workspace() const;

  // mean[p] of one line. `scatterers`: N/2 amplitudes, counts and phases as a Reflector's, one for
  // each depth bin. `counts`: N.
  void mean_counts(std::span<const std::complex<float>> scatterers,
                   std::span<const Reflector> surfaces, Workspace& workspace,
                   std::span<float> counts) const;

  // count[p]: noise (the same for the same key), saturation and rounding on mean[p].
  void expose(std::span<const float> mean, std::uint64_t noise_key,
              std::span<std::uint16_t> counts) const;

private:
  struct Tables;
  std::unique_ptr<const Tables> tables_;
};

} // namespace octascope::sim
