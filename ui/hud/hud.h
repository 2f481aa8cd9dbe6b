// Draws the heads-up display on a canvas.
#pragma once

#include <array>
#include <optional>
#include <span>

#include <glm/vec3.hpp>

#include "ui/canvas/canvas.h"
#include "ui/hud/hud_text.h"
#include "ui/hud/window_histogram.h"
#include "ui/layout/crop.h"
#include "ui/layout/layout.h"
#include "ui/layout/scan_field.h"
#include "ui/transfer/depth_colours.h"
#include "ui/view/camera.h"

namespace octascope::ui {

// What is on the screen, for scale bars, position lines and markers in the volume's space. Borrowed
// for one picture.
struct HudScene {
  ShownPictures shown;
  Camera camera{}; // of the eye being drawn
  glm::vec3 extents_mm{0};
  std::span<const pipeline::BScanState> states; // of the volume's B-scans
  Crop crop;                                    // of the flat pictures
  std::optional<ScanField> scan_field;
  std::optional<DepthColours> depth_colours; // of the volume, if it is coloured by depth
  const LevelShares* levels = nullptr;       // of the volume; null: no histogram
};

// Plates of the panels and of the status bar, drawn before the pictures.
void draw_hud_ground(Canvas& canvas, const Layout& layout);
// The volume's plate, which may cover part of the microscope picture.
void draw_view_ground(Canvas& canvas, const Layout& layout);

// Everything over the pictures.
void draw_hud(Canvas& canvas, const Layout& layout, const HudText& text, const ViewState& view,
              const HudScene& scene);

// The parts of the heads-up display, each in its own file.
using BadgePlaces = std::array<Rect, HudText::most_badges>;
BadgePlaces place_badges(const Canvas& canvas, const Layout& layout, const HudText& text);
void draw_badges(Canvas& canvas, const Layout& layout, const HudText& text);
void draw_liveness_marks(Canvas& canvas, const Layout& layout, Liveness liveness);
void draw_status_bar(Canvas& canvas, const Layout& layout, const HudText& text);
void draw_engineers_strip(Canvas& canvas, const Layout& layout, const HudText& text);
// What every thread did with the last volumes, in the manner of figure 7 of the OCT paper: filled
// where it works, framed where the volume waits.
void draw_timing_diagram(Canvas& canvas, const Rect& room, const Timing& timing, float unit);
void draw_panel_marks(Canvas& canvas, const Layout& layout, const HudText& text,
                      const ViewState& view, const HudScene& scene);

// The ticks of a depth ruler: 1, 2 or 5 times a power of ten of a millimetre, the smallest such step
// that is at least `least_mm`. Pure.
double round_ruler_step_mm(double least_mm);

// Depth rulers of the B-scans, the calliper, and where the crossed B-scans lie: in each other, in the
// en-face picture, and in the scan's field in the microscope's picture, each in a colour of its own.
// No number lies on `covered`.
void draw_scan_marks(Canvas& canvas, const Layout& layout, const ViewState& view,
                     const HudScene& scene, const Rect& covered);
glm::vec2 to_pixels(const Rect& rect, const ScanField::Corner& corner);
void draw_scan_field(Canvas& canvas, const Rect& rect, const ScanField& field,
                     const ViewState& view, const ShownPictures& shown, float unit);

// Markers in the volume's space: the wire-frame box, the plane of the panel's B-scan, and missing
// or saturated B-scans. `in_front` selects the parts in front of the volume, drawn over its
// picture; the others are drawn under it.
void draw_box_marks(Canvas& canvas, const Layout& layout, const ViewState& view,
                    const HudScene& scene, bool in_front);

// Only the wire-frame box, within `view`: the edges in front of the volume or those behind it.
void draw_wire_frame(Canvas& canvas, const Rect& view, const HudScene& scene, float unit,
                     bool in_front);

// The legend of the vessel colours and, if requested, the segment counts; above the scale of a
// large volume.
void draw_vessel_marks(Canvas& canvas, const Layout& layout, const VesselMarks& marks);

// A scale bar valid at the volume's centre, at the view's lower left.
void draw_view_scale(Canvas& canvas, const Layout& layout, const HudScene& scene);

// Which colour is which depth, if the volume is coloured by depth: a bar at the view's left border,
// between its upper and lower quarter, with ticks in µm or mm. Depths count from the volume's first, as
// those of the B-scans' rulers. Not in a view too small for its numbers.
Colour depth_hue(float place); // 0 to 1
bool has_room_for_depth_scale(const Layout& layout);
void draw_depth_scale(Canvas& canvas, const Layout& layout, const HudScene& scene);

// The orientation of the volume: a cube with a bright surface side, a dot where the scan begins
// (A-scan 0 of B-scan 0 at the surface), and the ends of its axes: the eye's sides if they are
// said (HudText::ends), else x along a B-scan, y from B-scan to B-scan, z with depth, under the
// user's own names.
void draw_orientation_cube(Canvas& canvas, const Rect& rect, const Camera& camera, float unit,
                           const HudText& text);

// A scale bar with its length as text: 1, 2 or 5 times a power of ten of a millimetre, at most
// `most_pixels` long. `left_bottom` is its lower left end. `medium`: medium_words() for lengths
// along depth, else empty.
void draw_scale_bar(Canvas& canvas, glm::vec2 left_bottom, double mm_per_pixel, float most_pixels,
                    float unit, std::string_view medium = {});

// The medium assumed for lengths along depth: "in air", "n 1.38", or "n ?" if the index is unknown.
// Pure.
FixedText<8> medium_words(const std::optional<double>& refractive_index);

// The longest such round length up to `longest_mm`, in mm. Pure.
double round_scale_length_mm(double longest_mm);

} // namespace octascope::ui
