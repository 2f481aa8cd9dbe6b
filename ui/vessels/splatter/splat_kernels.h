// Draws segments into pixels, several segments in the lanes of a register. Compiled for every
// instruction set, chosen at run time.
#pragma once

#include <cstdint>
#include <string_view>

#include "ui/vessels/splatter/splat_frame.h"

namespace octascope::ui {

// Functions of one instruction set. They neither allocate nor lock; several threads may draw
// different clusters into one picture.
struct SplatKernels {
  using Splat = SplatCounts (*)(const SplatFrame& frame, std::uint32_t first_cluster,
                                std::uint32_t end_cluster);
  const char* isa;
  Splat splat;
};

// The widest that this processor has, or the one named `isa`; nullptr if there is none.
const SplatKernels* splat_kernels(std::string_view isa = {});

} // namespace octascope::ui
