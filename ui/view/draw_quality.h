// How finely the volume is drawn. The governor (ui/pacing) sets it.
#pragma once

#include <cstdint>
#include <optional>

namespace octascope::ui {

// Who casts rays.
enum class RayBackend : std::uint8_t { shader, processor };

struct DrawQuality {
  float resolution = 1; // of the volume's picture, per display pixel and axis
  int steps = 256;      // samples along the longest edge of the volume's box; planes of a stack
                        // are as far apart
  std::optional<RayBackend> rays{}; // empty: the processor if GL is software, else the shader
  float vessel_detail_px = 0;       // vessels of a smaller radius are merged (ui/vessels/splatter)
  bool operator==(const DrawQuality&) const = default;
};

inline constexpr DrawQuality full_quality{1, 512};

} // namespace octascope::ui
