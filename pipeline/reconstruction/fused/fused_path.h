// The fused path of the reconstruction: whole B-scans through the kernels of fused_kernels.h.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "pipeline/calibration/calibration.h"
#include "pipeline/reconstruction/fused/fused_kernels.h"
#include "pipeline/reconstruction/fused/fused_tables.h"

namespace octascope::pipeline {

// Immutable once made; serves any number of threads, each with Buffers of its own.
class FusedPath {
public:
  // What one worker writes to.
  struct Buffers {
    AlignedVector<float> work;
    AlignedVector<std::int32_t> background; // resampled, see FusedTables::resample_background()
  };

  // Nothing where it does not apply: see make_fused_tables(), and recorded backgrounds so far from
  // the counts that fixed point overflows, and processors without `isa` (empty:
  // the widest they have).
  static std::optional<FusedPath> make(const Calibration& calibration, int bytes_per_sample,
                                       int right_shift, std::string_view isa);

  Buffers make_buffers() const;
  const char* isa() const { return kernels_->isa; }

  // Once per B-scan, before its lines: `background` has N values in counts after the shift.
  void set_background(const float* background, Buffers& buffers) const noexcept;

  // Lines without gaps → levels, N/2 each. `saturated`: by line, whether a shifted count is at
  // least `full_scale`; returns the number of such lines. Levels: std::uint8_t*, float* (dB) or
  // BinsAndLevels, the levels of which are those of the first, to the bit.
  template <class Levels>
  int reconstruct(const std::byte* counts, int lines, std::uint32_t full_scale, Buffers& buffers,
                  Levels levels, std::uint8_t* saturated) const noexcept;

private:
  void finish(float* work, std::uint8_t* levels) const noexcept;
  void finish(float* work, float* levels_db) const noexcept;
  void finish(float* work, const BinsAndLevels& both) const noexcept;

  FusedPath(FusedTables tables, const FusedKernels& kernels, RawKind kind);

  FusedTables tables_;
  const FusedKernels* kernels_;
  RawKind kind_;
  FusedKernels::FirstPass first_pass_;
};

} // namespace octascope::pipeline
