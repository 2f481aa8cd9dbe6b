// The fused reconstruction of one line: raw counts → levels in one pass through the first-level
// cache. Compiled for every instruction set, chosen at run time.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "pipeline/reconstruction/fused/fused_tables.h"
#include "pipeline/volume/packed_bin.h"

namespace octascope::pipeline {

// How raw samples become signed 16-bit numbers: as they are, less 32768, or shifted.
enum class RawKind : std::uint8_t { u8, u16, u16_shifted };
inline constexpr int raw_kinds = 3;

// What RawKind takes off each count.
constexpr int raw_offset(RawKind kind) {
  return kind == RawKind::u16 ? 32768 : 0;
}

// Functions of one instruction set. `work` has work_floats(N) floats on a cache line, `background`
// N values as resample_background() leaves them, also on a cache line. None allocates or locks.
struct FusedKernels {
  const char* isa;
  WindowShape window;

  // Counts → first radix of the transform → work. Fetches `next_line` into the cache meanwhile, and
  // says whether a count, before the shift, is at least `threshold`, which is one that the type
  // has.
  using FirstPass = bool (*)(const FusedTables& tables, const void* counts, const void* next_line,
                             std::uint32_t threshold, const std::int32_t* background, float* work);
  using FirstPasses = std::array<std::array<FirstPass, 2>, 2>;  // [one window][real input]
  std::array<std::array<FirstPasses, 3>, raw_kinds> first_pass; // [kind][log2 of the tap pairs]

  // The rest of the transform, bins 0 … N/2−1, and the levels, or both.
  void (*finish_u8)(const FusedTables& tables, float* work, std::uint8_t* levels);
  void (*finish_db)(const FusedTables& tables, float* work, float* levels_db);
  void (*finish_both)(const FusedTables& tables, float* work, const BinsAndLevels& both);
};

// N complex numbers, and the rows of powers and of packed bins.
constexpr std::size_t work_floats(int samples) {
  return static_cast<std::size_t>(3 * samples);
}

// The widest that this processor has and lines of `samples` have blocks enough for, or the one
// named `isa`; nullptr where there is no such one.
const FusedKernels* fused_kernels(int samples, std::string_view isa = {});

} // namespace octascope::pipeline
