// Kernels that draw segments into pixels, several segments in the lanes of a register. Compiled for
// every instruction set; the best is chosen at run time.
#pragma once

#include <cstdint>
#include <string_view>

#include "ui/vessels/splatter/splat_frame.h"

namespace octascope::ui {

// The functions of one instruction set. They neither allocate nor lock. Several threads may draw
// different clusters into one picture.
struct SplatKernels {
  using Splat = SplatCounts (*)(const SplatFrame& frame, std::uint32_t first_cluster,
                                std::uint32_t end_cluster);
  // Rows [top, bottom), once all clusters are drawn.
  using Smooth = void (*)(const SplatFrame& frame, int top, int bottom);
  const char* isa;
  Splat splat;
  Smooth smooth;
};

// The widest set that this processor has, or the one named `isa`; nullptr if it is not available.
const SplatKernels* splat_kernels(std::string_view isa = {});

} // namespace octascope::ui
