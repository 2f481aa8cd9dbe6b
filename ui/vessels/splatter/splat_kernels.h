// Kernels that draw segments into pixels, several segments in the lanes of a register. Compiled for
// every instruction set; the best is chosen at run time.
#pragma once

#include <cstdint>
#include <string_view>

#include "ui/vessels/splatter/splat_frame.h"

namespace octascope::ui {

// Columns [first, end) of a picture.
struct SplatColumns {
  int first = 0;
  int end = 0;
};

inline constexpr int smoothing_block = 256; // columns

// The functions of one instruction set. They neither allocate nor lock. Several threads may draw
// different clusters into one picture.
struct SplatKernels {
  using Splat = SplatCounts (*)(const SplatFrame& frame, std::uint32_t first_cluster,
                                std::uint32_t end_cluster);
  // Rows [top, bottom), once all clusters are drawn. Returns a bit for each block of columns that has
  // a vessel, the leftmost lowest.
  using Smooth = std::uint64_t (*)(const SplatFrame& frame, int top, int bottom);
  const char* isa;
  Splat splat;
  Smooth smooth;
};

// The widest set that this processor has, or the one named `isa`; nullptr if it is not available.
const SplatKernels* splat_kernels(std::string_view isa = {});

} // namespace octascope::ui
