// Ray-casting kernels: each traces a packet of neighbouring pixels in the lanes of a register.
// Compiled for every instruction set; the best is chosen at run time.
#pragma once

#include <cstdint>
#include <string_view>

#include "ui/ray_caster/ray_frame.h"

namespace octascope::ui {

// A tile of the picture; x and y are multiples of tile_size.
inline constexpr int tile_size = 32;
struct Tile {
  int x;
  int y;
};

// How levels become colour and opacity: by tables, grey or coloured, by a grey ramp, or by a table of
// greys whose hue is that of the depth.
enum class Look : std::uint8_t { grey, coloured, ramp, by_depth };
inline constexpr int look_count = 4;

// The functions of one instruction set. Each draws one tile and neither allocates nor locks.
struct RayKernels {
  using Draw = void (*)(const RayFrame& frame, Tile tile);
  const char* isa;
  struct Modes {
    Draw composite[look_count]; // by Look
    Draw shaded[look_count];
    Draw maximum;
  };
  Modes plain;
  Modes with_flow;
};

// The widest set that this processor has, or the one named `isa`; nullptr if it is not available.
const RayKernels* ray_kernels(std::string_view isa = {});

} // namespace octascope::ui
