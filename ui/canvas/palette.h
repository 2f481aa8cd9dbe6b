// The colours of the display, and the contrast rule that keeps text legible.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

namespace octascope::ui {

struct Colour {
  std::uint8_t r = 0;
  std::uint8_t g = 0;
  std::uint8_t b = 0;
  std::uint8_t a = 255;

  constexpr Colour faded(std::uint8_t alpha) const { return {r, g, b, alpha}; }
  constexpr bool operator==(const Colour&) const = default;
};

namespace palette {

inline constexpr Colour background{9, 12, 15}; // behind the volume
inline constexpr Colour panel{18, 23, 28};     // under text
inline constexpr Colour hairline{44, 53, 62};
inline constexpr Colour text{233, 238, 242};
inline constexpr Colour quiet_text{168, 179, 189};
inline constexpr Colour box{104, 120, 134}; // the wire frame, in front of the volume
inline constexpr Colour box_behind{58, 69, 79};
inline constexpr Colour cube_surface{150, 166, 180}; // the side of the orientation cube
inline constexpr Colour histogram{120, 134, 148};
inline constexpr Colour accent{102, 200, 255}; // positions and the knob's parameter
inline constexpr Colour calliper{255, 240, 120};
inline constexpr Colour crossed{255, 140, 214}; // the crossed B-scan's position
inline constexpr Colour seam{150, 255, 120};    // between two volumes of which one is newer
// Colours of states. Distinguishable for colour-blind people; no state is shown by colour alone.
inline constexpr Colour good{90, 190, 160};
inline constexpr Colour warning{255, 186, 74}; // STALE, missing, saturated, lost
inline constexpr Colour alarm{255, 140, 106};  // no live picture, failed
inline constexpr Colour frozen{175, 214, 255};
inline constexpr Colour simulated{202, 152, 255};
inline constexpr Colour recording{160, 0, 12}; // as a plate, the only red one
inline constexpr Colour replay = text;         // as a plate: the only white one
inline constexpr Colour ink{8, 11, 14}; // text on a filled badge, shadow of text on a picture
inline constexpr Colour plate = panel.faded(242); // under text over a picture

// Every combination of text colour and background that the display uses.
struct TextOnGround {
  Colour text;
  Colour ground;
};
inline constexpr std::array texts_on_grounds{
    TextOnGround{text, panel},         TextOnGround{text, background},
    TextOnGround{text, plate},         TextOnGround{text, ink},
    TextOnGround{quiet_text, panel},   TextOnGround{quiet_text, background},
    TextOnGround{quiet_text, plate},   TextOnGround{quiet_text, ink},
    TextOnGround{accent, panel},       TextOnGround{accent, plate},
    TextOnGround{good, panel},         TextOnGround{warning, panel},
    TextOnGround{warning, background}, TextOnGround{alarm, panel},
    TextOnGround{alarm, background},   TextOnGround{frozen, panel},
    TextOnGround{seam, panel},         TextOnGround{simulated, panel},
    TextOnGround{ink, warning},        TextOnGround{ink, alarm},
    TextOnGround{ink, frozen},         TextOnGround{ink, replay},
    TextOnGround{text, recording}};

// Colours that show the state of the picture or of a device.
inline constexpr std::array states{text, good, warning, alarm, frozen, simulated};

} // namespace palette

// Relative luminance and contrast ratio as WCAG 2 defines them.
inline double luminance(Colour colour) {
  const auto linear = [](std::uint8_t value) {
    const double s = value / 255.0;
    return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
  };
  return 0.2126 * linear(colour.r) + 0.7152 * linear(colour.g) + 0.0722 * linear(colour.b);
}

inline double contrast(Colour a, Colour b) {
  const double la = luminance(a) + 0.05;
  const double lb = luminance(b) + 0.05;
  return la > lb ? la / lb : lb / la;
}

} // namespace octascope::ui
