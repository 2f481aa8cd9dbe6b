// Spectra → depth profiles: one B-scan of raw lines becomes one B-scan of levels.
//
// The chain for one line of N samples s[p]:
//   shift, s − background[p]; x[m] = s(r[m]) (k-linearisation by taps);
//   y[m] = x[m]·w[m]·exp(iθ[m])/N (one complex factor a sample; real without dispersion);
//   Y = FFT(y), bins 0 … N/2−1; level = 10·log10(|Y|²) dB, which is 20·log10(|FFT|/N).
// Single precision. Two paths with one meaning: FFTW in the middle, for any N and type; and the
// fused one (fused_kernels.h), a line in one pass, for integer counts and N = 256, 512 … 8192.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "hal/line_camera.h"
#include "hal/result.h"
#include "pipeline/calibration.h"

namespace octascope::pipeline {

enum class SpectrumType : std::uint8_t { u8, u16, f32 };

constexpr std::size_t bytes_per_sample(SpectrumType type) {
  return type == SpectrumType::u8 ? 1 : type == SpectrumType::u16 ? 2 : 4;
}

// Little-endian samples, lines without gaps. Shift and full scale mean nothing to f32.
struct SpectrumFormat {
  int samples = 1024;
  SpectrumType type = SpectrumType::u16;
  int significant_bits = 16; // full scale is 2^significant_bits − 1 after the shift
  int right_shift = 0;

  SpectrumFormat() = default;
  SpectrumFormat(int samples_per_line, SpectrumType sample_type);
  explicit SpectrumFormat(const hal::LineFormat& line);

  std::size_t line_bytes() const {
    return static_cast<std::size_t>(samples) * bytes_per_sample(type);
  }
};

// Which of the two. `fused` where it does not apply gives FFTW's.
enum class ReconstructionPath : std::uint8_t {
  automatic, // the faster one, measured for some milliseconds when the Reconstructor is made
  fftw,
  fused,
};

struct ReconstructionSetup {
  Calibration calibration;
  SpectrumFormat format;
  int a_scans = 300; // kept lines of a B-scan, the first of each frame
  ReconstructionPath path = ReconstructionPath::automatic;
  // Of the fused path, to compare: AVX3, AVX2, SSE4 or NEON; empty: the widest there is.
  std::string fused_isa = {};
};

struct BScanOutcome {
  int saturated_lines = 0; // with at least one sample at full scale
};

// Immutable once made: one Reconstructor serves any number of threads, each with a Workspace of its
// own. It must outlive them.
class Reconstructor {
public:
  // What one worker writes to: line buffers and the background. Use it from one thread at a time.
  class Workspace {
  public:
    Workspace(Workspace&&) noexcept;
    Workspace& operator=(Workspace&&) noexcept;
    ~Workspace();

    // Forgets the running background, as if no B-scan had been seen.
    void reset_background();

  private:
    friend class Reconstructor;
    struct Buffers;
    explicit Workspace(std::unique_ptr<Buffers> buffers);
    std::unique_ptr<Buffers> buffers_;
  };

  // Plans the transform, which takes some milliseconds. Fault::invalid_argument or bad_data with
  // found and expected where calibration and format do not fit together.
  static hal::Result<Reconstructor> create(const ReconstructionSetup& setup);

  Reconstructor(Reconstructor&&) noexcept;
  Reconstructor& operator=(Reconstructor&&) noexcept;
  ~Reconstructor();

  int samples() const;
  int depths() const; // samples / 2, rounded down
  int a_scans() const;
  std::size_t kept_bytes() const; // of the kept lines of a frame: the least that a frame has
  std::size_t levels() const;     // of a B-scan: a_scans × depths

  ReconstructionPath path() const; // fftw or fused, what was chosen
  // The instruction set of the fused kernels ("AVX3", "AVX2", …); "native" for FFTW's path, whose
  // loops choose their own.
  const char* isa() const;

  Workspace make_workspace() const;

  // `frame` begins with the kept lines, at least kept_bytes() and aligned for its sample type;
  // fly-back lines behind them are not read. `levels` has levels() values [a][z], depth fastest.
  // Neither allocates, locks nor logs.
  BScanOutcome reconstruct_b_scan(Workspace& workspace, std::span<const std::byte> frame,
                                  std::span<std::uint8_t> levels) const noexcept;
  // The same in decibels, not quantised, for exports. Floats in `frame` must be finite.
  BScanOutcome reconstruct_b_scan_db(Workspace& workspace, std::span<const std::byte> frame,
                                     std::span<float> levels_db) const noexcept;

private:
  struct Plan;
  explicit Reconstructor(std::unique_ptr<const Plan> plan);
  std::unique_ptr<const Plan> plan_;
};

} // namespace octascope::pipeline
