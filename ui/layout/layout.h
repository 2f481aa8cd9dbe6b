// Where everything is on the screen. Pure.
//
// Sizes are for two metres of distance from a screen of 27 inches; ui/hud/fonts.h has the rule for
// text. What the heads-up display may cover of the large picture lies in the outer quarters of its
// stage: the middle half of its width and height is never covered but by the veil.
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

// Nothing of an empty panel is drawn.
struct Panel {
  Rect frame;
  Rect title;   // in the frame, above the picture
  Rect picture; // in the frame, with the aspect of what it shows

  bool shown() const { return !picture.empty(); }
};

// Physical width / height of the pictures.
struct PictureAspects {
  double b_scan = 1.6;
  double en_face = 1;
  double scope = 4.0 / 3;
  bool has_scope = true; // there is a microscope picture
  bool operator==(const PictureAspects&) const = default;
};

struct Layout {
  LayoutKind kind = LayoutKind::volume; // what is laid out: see lay_out()
  float unit = 1;  // pixels per pixel of a picture 720 high: all sizes of the display scale with it
  Rect view;       // the volume
  Rect view_frame; // around it where it has a plate and a title, else empty
  Rect view_title;
  bool inset = false; // the view lies over the microscope's picture, at its lower right corner
  Panel b_scan;
  Panel en_face;
  Panel scope;
  Rect status_bar;

  Rect large; // the large picture; of four alike, the volume
  Rect stage; // it and what is free around it, the picture in the middle

  // For the heads-up display; empty where there is no room.
  Rect marks;     // the badges, row by row from the left
  Rect notice;    // one line
  Rect echo;      // what a control just did: at the lower border of the stage
  Rect legend;    // what each control does: in place of the small pictures beside the large one, of
                  // the last of four alike, or at the side over a picture with an inset
  Rect histogram; // of the levels: in the stage's lower right corner
  Rect cube;      // which way the volume is turned: in the view's upper right corner
};

// volume: the volume left, about 70 % of the width; the other pictures in a column right of it.
// b_scan: the same with the B-scan left and the volume in the column. microscope: its picture at
// the left; the volume, and where there is room the B-scan, beside it, or the volume as an inset.
// quad: four alike. Pictures that are taller than wide get a row below in place of the column; the
// status bar is at the bottom. Without a microscope picture the others share its room, and the
// layout for it is that of the volume.
Layout lay_out(int width, int height, const PictureAspects& aspects,
               LayoutKind kind = LayoutKind::volume);

} // namespace octascope::ui
