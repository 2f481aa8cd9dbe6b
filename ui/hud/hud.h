// Lays the heads-up display out on a canvas.
#pragma once

#include <array>
#include <optional>
#include <span>

#include <glm/vec3.hpp>

#include "ui/hud/canvas.h"
#include "ui/hud/hud_text.h"
#include "ui/hud/window_histogram.h"
#include "ui/layout/layout.h"
#include "ui/layout/scan_field.h"
#include "ui/view/camera.h"

namespace octascope::ui {

// What is on the screen: for scale bars, position lines and marks in the volume's space. Borrowed
// for one picture.
struct HudScene {
  ShownPictures shown;
  Camera camera{}; // of the eye whose picture it is
  glm::vec3 extents_mm{0};
  std::span<const pipeline::BScanState> states; // of the volume's B-scans
  std::optional<ScanField> scan_field;
  const LevelShares* levels = nullptr; // of the volume; none: no histogram
};

// Plates of the panels and of the status bar, drawn before the pictures.
void draw_hud_ground(Canvas& canvas, const Layout& layout);
// The volume's plate, which may lie over the microscope's picture.
void draw_view_ground(Canvas& canvas, const Layout& layout);

// Everything over the pictures.
void draw_hud(Canvas& canvas, const Layout& layout, const HudText& text, const ViewState& view,
              const HudScene& scene);

// Its parts, each in a file of its own.
using BadgePlaces = std::array<Rect, HudText::most_badges>;
BadgePlaces place_badges(const Canvas& canvas, const Layout& layout, const HudText& text);
void draw_badges(Canvas& canvas, const Layout& layout, const HudText& text);
void draw_liveness_marks(Canvas& canvas, const Layout& layout, Liveness liveness);
void draw_status_bar(Canvas& canvas, const Layout& layout, const HudText& text);
void draw_panel_marks(Canvas& canvas, const Layout& layout, const HudText& text,
                      const ViewState& view, const HudScene& scene);

// Marks in the volume's space: the wire-frame box, the plane of the B-scan in the panel, and where
// B-scans are missing or saturated. Parts before the volume are drawn over its picture, the others
// under it.
void draw_box_marks(Canvas& canvas, const Layout& layout, const ViewState& view,
                    const HudScene& scene, bool in_front);

// The wire-frame box alone, within `view`; the edges before the volume or those behind it.
void draw_wire_frame(Canvas& canvas, const Rect& view, const HudScene& scene, float unit,
                     bool in_front);

// The vessels' colour key and, if requested, where their segments went: above the scale of a large
// volume.
void draw_vessel_marks(Canvas& canvas, const Layout& layout, const VesselMarks& marks);

// How long a millimetre at the volume's centre is, at the view's lower left.
void draw_view_scale(Canvas& canvas, const Layout& layout, const HudScene& scene);

// The volume's orientation: a cube with the surface side bright, a dot where the scan begins
// (A-scan 0 of B-scan 0 at the surface), and the axes: x along a B-scan, y from B-scan to B-scan, z
// with depth.
void draw_orientation_cube(Canvas& canvas, const Rect& rect, const Camera& camera, float unit);

// A bar of a round length (1, 2 or 5 times a power of ten of a millimetre), at most `most_pixels`
// long, labelled with its length; `left_bottom` is its lower left end. `medium`: medium_words() for
// lengths along depth, else empty.
void draw_scale_bar(Canvas& canvas, glm::vec2 left_bottom, double mm_per_pixel, float most_pixels,
                    float unit, std::string_view medium = {});

// The medium for which lengths along depth hold: "in air", "n 1.38", or "n ?" if the index is
// unknown. Pure.
FixedText<8> medium_words(const std::optional<double>& refractive_index);

// That length in mm. Pure.
double round_scale_length_mm(double longest_mm);

} // namespace octascope::ui
