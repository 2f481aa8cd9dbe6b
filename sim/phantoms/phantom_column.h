// The structure below one lateral position of a phantom, by depth in millimetres.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace octascope::sim {

// The variation of scattering inside a layer.
enum class Grain : std::uint8_t {
  none,
  lamellae, // thin sheets that follow the layer's top
  granules, // lumps
};

// The flow in a vessel's lumen, below one place.
struct LumenFlow {
  float axis_mm = 0;         // depth of the vessel's axis
  float aside_mm = 0;        // of the place, from the axis as seen from above
  float radius_mm = 0;       // 0: nothing flows
  float across_mm_per_s = 0; // at the axis: level, and downwards
  float along_mm_per_s = 0;

  // Speed relative to that at the axis, 0 … 1: a parabola.
  float speed_at(float depth_mm) const {
    const float off = depth_mm - axis_mm;
    const float squared = radius_mm * radius_mm;
    return squared > 0 ? std::max(1 - (aside_mm * aside_mm + off * off) / squared, 0.0F) : 0;
  }
};

struct Layer {
  float top_mm = 0;
  float bottom_mm = 0;
  float backscatter_counts = 0; // rms fringe amplitude of one depth bin's scatterers
  float attenuation_per_mm = 0; // of amplitude, round trip
  Grain grain = Grain::none;
  float grain_strength = 0; // 0 … 1: variation of the backscatter, relative
  bool flowing = false;     // its scatterers are new in each volume; between repeats, as `flow`
  LumenFlow flow{};
};

// A smooth surface: reflects at an exact depth and transmits a part of the light.
struct Surface {
  float depth_mm = 0;
  float amplitude_counts = 0;
  float transmission = 1; // of amplitude, round trip; 0 casts a full shadow
};

// Fixed capacity, so that columns are refilled without allocation; excess entries are dropped.
class Column {
public:
  static constexpr std::size_t most_layers = 32;
  static constexpr std::size_t most_surfaces = 12;

  void clear() { layers_ = surfaces_ = 0; }
  // Later layers replace earlier ones where they overlap: add vessels after their tissue.
  void add(const Layer& layer) {
    if (layer.bottom_mm > layer.top_mm && layers_ < most_layers)
      layer_room_[layers_++] = layer;
  }
  void add(const Surface& surface) {
    if (surfaces_ < most_surfaces)
      surface_room_[surfaces_++] = surface;
  }

  std::span<const Layer> layers() const { return std::span{layer_room_}.first(layers_); }
  std::span<const Surface> surfaces() const { return std::span{surface_room_}.first(surfaces_); }

private:
  std::array<Layer, most_layers> layer_room_;
  std::array<Surface, most_surfaces> surface_room_;
  std::size_t layers_ = 0;
  std::size_t surfaces_ = 0;
};

} // namespace octascope::sim
