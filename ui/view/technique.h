// The ways of drawing a volume.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

namespace octascope::ui {

enum class Technique : std::uint8_t {
  slices,  // object-aligned stack: the volume's own slices along the axis nearest to the view
  planes,  // view-aligned stack: planes perpendicular to the view through the 3D texture
  rays,    // ray casting, front to back, with early termination and skipping of empty bricks
  shaded,  // the same, with gradient lighting and a depth cue
  maximum, // maximum intensity projection
  surface, // iso-surface, shaded
};

inline constexpr std::array all_techniques{Technique::slices,  Technique::planes,
                                           Technique::rays,    Technique::shaded,
                                           Technique::maximum, Technique::surface};

// Rays are cast by a shader or by the processor; everything else is drawn by GL.
constexpr bool casts_rays(Technique technique) {
  return technique == Technique::rays || technique == Technique::shaded ||
         technique == Technique::maximum;
}

// As on the command line, in profiles and on the display: "rays".
std::string_view to_string(Technique technique);
std::optional<Technique> technique_named(std::string_view name);

} // namespace octascope::ui
