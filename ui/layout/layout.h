// Where everything is on the screen. Pure.
//
// Sizes are for a 27-inch screen at a distance of two metres; see ui/hud/fonts.h for text. The
// heads-up display may cover only the outer quarters of the large picture's stage: the middle half
// of its width and height is never covered, except by the veil.
#pragma once

#include "ui/view/view_state.h"

namespace octascope::ui {

// Pixels from the top left corner.
struct Rect {
  int x = 0;
  int y = 0;
  int width = 0;
  int height = 0;

  int right() const { return x + width; }
  int bottom() const { return y + height; }
  bool empty() const { return width <= 0 || height <= 0; }
  bool operator==(const Rect&) const = default;
};

// What sizes grow to: that of a picture 4320 pixels high (8K). Letters have a largest size
// (ui/hud/fonts.h), and what surrounds them does not grow without them.
inline constexpr float largest_unit = 6;

// A panel that is empty is not drawn.
struct Panel {
  Rect frame;
  Rect title;   // in the frame, above the picture
  Rect picture; // in the frame, with the aspect of what it shows

  bool shown() const { return !picture.empty(); }
};

// Width / height of the pictures in physical units.
struct PictureAspects {
  double b_scan = 1.6;
  double en_face = 1;
  double scope = 4.0 / 3;
  bool has_scope = true; // there is a microscope picture
  double crossed = 1.6;  // the crossed B-scan
  bool operator==(const PictureAspects&) const = default;
};

struct Layout {
  LayoutKind kind = LayoutKind::volume; // the layout actually used: see lay_out()
  float unit = 1;                       // scale of all sizes: 1 for a picture 720 pixels high, at
                                        // most largest_unit
  Rect view;                            // the volume
  Rect view_frame;                      // around it if it has a plate and a title, else empty
  Rect view_title;
  bool inset = false; // the view lies over the microscope's picture, at its lower right corner
  Panel b_scan;
  Panel crossed; // the crossed B-scan, where there is room
  Panel en_face;
  Panel scope;
  Rect status_bar;

  Rect large; // the large picture; in the quad layout, the volume
  Rect stage; // the large picture centred in its free surroundings

  // For the heads-up display; empty if there is no room.
  Rect marks;     // the badges, row by row from the left
  Rect notice;    // one line
  Rect echo;      // what a control just did: at the lower border of the stage
  Rect legend;    // what each control does: replaces the small pictures beside the large one or the
                  // last of four alike, or lies at the side over a picture with an inset
  Rect histogram; // of the levels: in the stage's lower right corner
  Rect cube;      // the volume's orientation: in the view's upper right corner
};

// volume: the volume at the left, about 70 % of the width; the other pictures in a column at its
// right. b_scan: the same, with the B-scan at the left and the volume in the column; the crossed
// B-scan is below it or at the head of the column, in the other layouts beside it if both keep half
// of the room. microscope:
// the microscope picture at the left; the volume, and the B-scan if there is room, beside it, or
// the volume as an inset. quad: four of equal size. If pictures are taller than wide, a row below
// replaces the column. The status bar is at the bottom. Without a microscope picture the others
// share its room, and the microscope layout becomes that of the volume.
Layout lay_out(int width, int height, const PictureAspects& aspects,
               LayoutKind kind = LayoutKind::volume);

} // namespace octascope::ui
