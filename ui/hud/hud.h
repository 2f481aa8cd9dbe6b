// Lays the heads-up display out on a canvas.
#pragma once

#include <optional>

#include "ui/hud/canvas.h"
#include "ui/hud/hud_text.h"
#include "ui/layout.h"
#include "ui/scan_field.h"

namespace octascope::ui {

// Geometry of what is on the screen, for scale bars and position lines.
struct HudScene {
  ShownPictures shown;
  double view_mm_per_pixel = 0; // at the centre of the volume
  std::optional<ScanField> scan_field;
};

// Plates and titles of the panels and the status bar, drawn before the pictures.
void draw_hud_ground(Canvas& canvas, const Layout& layout);

// Everything over the pictures.
void draw_hud(Canvas& canvas, const Layout& layout, const HudText& text, const ViewState& view,
              const HudScene& scene);

// The parts of it; each in a file of its own.
void draw_badges(Canvas& canvas, const Layout& layout, const HudText& text);
void draw_liveness_marks(Canvas& canvas, const Layout& layout, Liveness liveness);
void draw_status_bar(Canvas& canvas, const Layout& layout, const HudText& text);
void draw_panel_marks(Canvas& canvas, const Layout& layout, const HudText& text,
                      const ViewState& view, const HudScene& scene);
// A bar of a round length (1, 2 or 5 times a power of ten of a millimetre), at most `most_pixels`
// long, with its length; its left lower end is given.
void draw_scale_bar(Canvas& canvas, glm::vec2 left_bottom, double mm_per_pixel, float most_pixels,
                    float unit);

// That length in mm. Pure.
double round_scale_length_mm(double longest_mm);

} // namespace octascope::ui
