// Where everything is on the screen. Pure.
//
// Sizes are for a 27-inch screen at a distance of two metres; see ui/canvas/fonts.h for text. The
// heads-up display may cover only the outer quarters of the large picture: the middle half of its
// width and height is never covered, except by the veil. No text lies over a small picture but
// that picture's own scale, sides and states.
#pragma once

#include "ui/view/view_state.h"

namespace octascope::ui {

// Pixels from the top left corner.
struct Rect {
  int x = 0;
  int y = 0;
  int width = 0;
  int height = 0;

  constexpr int right() const { return x + width; }
  constexpr int bottom() const { return y + height; }
  constexpr bool empty() const { return width <= 0 || height <= 0; }
  bool operator==(const Rect&) const = default;
};

// What lies in both; may be empty.
constexpr Rect common(const Rect& a, const Rect& b) {
  const int x = a.x > b.x ? a.x : b.x;
  const int y = a.y > b.y ? a.y : b.y;
  const int right = a.right() < b.right() ? a.right() : b.right();
  const int bottom = a.bottom() < b.bottom() ? a.bottom() : b.bottom();
  return {x, y, right - x, bottom - y};
}

// What sizes grow to: that of a picture 4320 pixels high (8K). Letters have a largest size
// (ui/canvas/fonts.h), and what surrounds them does not grow without them.
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

// What the pictures make room for.
struct Extras {
  bool figures = false; // the engineer's strip
  bool legend = false;  // what each control does: instead of small pictures
  bool timing = false;  // the timing diagram
};

struct Layout {
  LayoutKind kind = LayoutKind::volume; // the layout actually used: see lay_out()
  float unit = 1;                       // scale of all sizes: 1 for a picture 720 pixels high, at
                                        // most largest_unit
  Rect view;                            // the volume; empty where the legend takes its place
  Rect view_frame;                      // around it if it has a plate and a title, else empty
  Rect view_title;
  Panel b_scan;
  Panel crossed; // the crossed B-scan, where there is room
  Panel en_face;
  Panel scope;
  Rect status_bar;
  Rect notice;  // one line, at the bar's top
  Rect figures; // above the bar, if asked for
  Rect timing;  // above the figures, if asked for

  Rect large; // the large picture; in the quad layout, the volume

  // For the heads-up display; empty if there is no room.
  Rect marks;     // the badges, row by row from the left
  Rect legend;    // if asked for
  Rect histogram; // of the levels: in the large picture's lower right corner
  Rect cube;      // the volume's orientation: in the view's right quarter
};

// volume: the volume at the left, badges over its upper quarter. b_scan, microscope: that picture
// at the left. The others are in a column at the right: the first of volume and B-scan that is not
// large on top, the other two side by side under it, or all three under each other where that is
// larger. quad: four of equal size. The crossed B-scan is below a large B-scan or at the head of a
// wider column, else beside the B-scan if both keep half of the room, or beside the en face. All but
// the first have the badges in a row above. If pictures are taller than wide, a row below replaces the column. The
// status bar is at the bottom. Without a microscope picture the others share its room, and the
// microscope layout becomes that of the volume.
Layout lay_out(int width, int height, const PictureAspects& aspects,
               LayoutKind kind = LayoutKind::volume, const Extras& extras = {});

} // namespace octascope::ui
