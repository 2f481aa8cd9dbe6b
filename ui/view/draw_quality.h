// The drawing quality of the volume, set by the governor (ui/pacing).
#pragma once

#include <cstdint>
#include <optional>

namespace octascope::ui {

// What casts the rays.
enum class RayBackend : std::uint8_t { shader, processor };

struct DrawQuality {
  float resolution = 1; // of the volume's picture, per display pixel and axis
  int steps = 256;      // samples along the longest edge of the volume's box; sets the distance of
                        // the planes of a stack, too
  std::optional<RayBackend> rays{}; // default: the processor if GL is software, else the shader
  float vessel_detail_px = 0;       // vessels of a smaller radius are merged (ui/vessels/splatter)
  bool vessels_occluded = true;     // vessels shade what lies close behind them
  bool operator==(const DrawQuality&) const = default;
};

inline constexpr DrawQuality full_quality{1, 512};

} // namespace octascope::ui
