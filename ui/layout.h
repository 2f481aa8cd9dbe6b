// Where everything is on the screen. Pure.
#pragma once

namespace octascope::ui {

// Pixels from the top left corner.
struct Rect {
  int x = 0;
  int y = 0;
  int width = 0;
  int height = 0;

  int right() const { return x + width; }
  int bottom() const { return y + height; }
  bool operator==(const Rect&) const = default;
};

struct Panel {
  Rect frame;
  Rect title;   // in the frame, above the picture
  Rect picture; // in the frame, with the aspect of what it shows
};

// Physical width / height of the pictures.
struct PictureAspects {
  double b_scan = 1.6;
  double en_face = 1;
  double scope = 4.0 / 3;
  bool operator==(const PictureAspects&) const = default;
};

struct Layout {
  float unit = 1; // pixels per pixel of a picture 720 high: all sizes of the display scale with it
  Rect view;      // the volume
  Panel b_scan;
  Panel en_face;
  Panel scope;
  Rect status_bar;
};

// The volume left, about 70 % of the width; B-scan, en face and microscope in a column right of it;
// the status bar below.
Layout lay_out(int width, int height, const PictureAspects& aspects);

} // namespace octascope::ui
