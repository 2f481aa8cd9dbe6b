// Casts rays through the volume, a packet of neighbouring pixels in the lanes of a register.
// Compiled for every instruction set, chosen at run time.
#pragma once

#include <cstdint>
#include <string_view>

#include "ui/ray_caster/ray_frame.h"

namespace octascope::ui {

// A part of the picture; x and y are multiples of tile_size.
inline constexpr int tile_size = 32;
struct Tile {
  int x;
  int y;
};

// How levels become light: by tables, in grey or in colour, or by a grey ramp.
enum class Look : std::uint8_t { grey, coloured, ramp };

// Functions of one instruction set. Each draws one tile and neither allocates nor locks.
struct RayKernels {
  using Draw = void (*)(const RayFrame& frame, Tile tile);
  const char* isa;
  Draw composite[3]; // by Look
  Draw shaded[3];
  Draw maximum;
};

// The widest that this processor has, or the one named `isa`; nullptr if there is none.
const RayKernels* ray_kernels(std::string_view isa = {});

} // namespace octascope::ui
