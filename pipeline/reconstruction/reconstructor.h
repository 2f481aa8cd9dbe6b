// Spectra → depth profiles: one B-scan of raw lines becomes one B-scan of levels.
//
// The chain for one line of N samples s[p]:
//   shift, s − background[p]; x[m] = s(r[m]) (k-linearisation by taps);
//   y[m] = x[m]·w[m]·exp(iθ[m])/N (one complex factor a sample; real without dispersion);
//   Y = FFT(y), bins 0 … N/2−1 (with zero-padding: of 2N samples, bins 0 … N−1);
//   on request, the pattern fixed in all A-scans is subtracted from Y (fixed_pattern.h);
//   level = 10·log10(|Y|²) dB, which is 20·log10(|FFT|/N).
// Single precision. Two paths with one meaning: FFTW's (fftw_path.h), for everything; and the fused
// one (fused_path.h), a line in one pass, for integer counts and N = 256, 512 … 8192.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "hal/result.h"
#include "pipeline/calibration/calibration.h"
#include "pipeline/reconstruction/background.h"
#include "pipeline/reconstruction/path_choice.h"
#include "pipeline/reconstruction/spectrum_format.h"
#include "pipeline/volume/packed_bin.h"

namespace octascope::pipeline {

struct ReconstructionSetup {
  Calibration calibration;
  SpectrumFormat format;
  int a_scans = 300; // kept lines of a B-scan, the first of each frame
  ReconstructionPath path = ReconstructionPath::automatic;
  // Of the fused path, to compare: AVX3, AVX2, SSE4 or NEON; empty: the widest there is.
  std::string fused_isa = {};
  // Borrowed while the Reconstructor is made: keeps the times that `automatic` measures. nullptr:
  // they are measured each time, for some milliseconds.
  PathMemory* memory = nullptr;
  // For pictures: a saturated line, lit up at all depths by clipping, is made no brighter at any
  // depth than the nearest unsaturated ones on either side of it.
  bool limit_saturated_lines = false;
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

  private:
    friend class Reconstructor;
    struct Buffers;
    explicit Workspace(std::unique_ptr<Buffers> buffers);
    std::unique_ptr<Buffers> buffers_;
  };

  // Plans the transform, which takes some milliseconds. ErrorCode::invalid_argument or bad_data
  // with found and expected where calibration and format do not fit together.
  static hal::Result<Reconstructor> create(const ReconstructionSetup& setup);

  Reconstructor(Reconstructor&&) noexcept;
  Reconstructor& operator=(Reconstructor&&) noexcept;
  ~Reconstructor();

  int samples() const;
  int depths() const; // Calibration::depths(): samples / 2, rounded down, without zero-padding
  int a_scans() const;
  std::size_t levels() const; // of a B-scan: a_scans × depths

  ReconstructionPath path() const; // fftw or fused, what was chosen
  // The instruction set of the fused kernels ("AVX3", "AVX2", …); "native" for FFTW's path, whose
  // loops choose their own.
  const char* isa() const;
  const PathDecision& path_decision() const;

  Workspace make_workspace() const;
  // BackgroundMode::running only: hands out the background of each B-scan, in order. `sweeps`:
  // B-scans a volume, each repeat counted.
  std::optional<RunningBackground> make_running_background(int sweeps) const;

  // `frame` begins with the a_scans() kept lines, aligned for its sample type; the fly-back lines
  // after them are not read. `levels` has levels() values [a][z], depth fastest.
  // `running`: with BackgroundMode::running, the result of RunningBackground::add() for this
  // B-scan; ignored otherwise. Without it this B-scan's mean is taken, as with mode "mean".
  // None of them allocates, locks or logs.
  BScanOutcome reconstruct_b_scan(Workspace& workspace, std::span<const std::byte> frame,
                                  std::span<std::uint8_t> levels,
                                  std::span<const float> running = {}) const noexcept;
  // The same in decibels, not quantised, for exports. Floats in `frame` must be finite.
  BScanOutcome reconstruct_b_scan_db(Workspace& workspace, std::span<const std::byte> frame,
                                     std::span<float> levels_db,
                                     std::span<const float> running = {}) const noexcept;
  // With one transform the levels of reconstruct_b_scan(), to the bit, and the complex bins that they
  // are of, Y above, whose phase tells of motion. Bins of saturated lines stay as they are.
  BScanOutcome reconstruct_b_scan_both(Workspace& workspace, std::span<const std::byte> frame,
                                       std::span<PackedBin> bins, std::span<std::uint8_t> levels,
                                       std::span<const float> running = {}) const noexcept;
  // Of the B-scan reconstructed last in that workspace, by line: whether it was saturated, 0 or 1.
  std::span<const std::uint8_t> saturated_lines(const Workspace& workspace) const noexcept;

private:
  struct Plan;
  explicit Reconstructor(std::unique_ptr<const Plan> plan);
  std::unique_ptr<const Plan> plan_;
};

} // namespace octascope::pipeline
