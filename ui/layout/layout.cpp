#include "ui/layout/layout.h"

#include <algorithm>
#include <cmath>

namespace octascope::ui {

namespace {

constexpr double column_share = 0.3;       // of the width
constexpr double wide_column_share = 0.39; // with the crossed B-scan at its head
constexpr double inset_share = 0.26; // less than a quarter of any picture that it lies over is hid

// Lengths at unit 1.
constexpr float gap_length = 8;
constexpr float title_length = 34;
constexpr float bar_length = 76;
constexpr float marks_length = 60; // one row of badges
constexpr float edge = 16;         // from the borders of a picture to what lies over it

double area(const Rect& rect) {
  return static_cast<double>(rect.width) * rect.height;
}

int scaled(float unit, float length) {
  return std::max(1, static_cast<int>(std::lround(unit * length)));
}

// The largest rectangle of that aspect within `room`, centred.
Rect fit(const Rect& room, double aspect) {
  const int width =
      std::clamp(static_cast<int>(std::lround(room.height * aspect)), 1, std::max(1, room.width));
  const int height =
      std::clamp(static_cast<int>(std::lround(width / aspect)), 1, std::max(1, room.height));
  return {room.x + (room.width - width) / 2, room.y + (room.height - height) / 2, width, height};
}

Rect title_of(const Rect& frame, float unit) {
  const int margin = scaled(unit, gap_length);
  return {frame.x + margin, frame.y, std::max(1, frame.width - 2 * margin),
          std::min(frame.height, scaled(unit, title_length))};
}

// What a frame leaves for the picture under its title.
Rect room_of(const Rect& frame, float unit) {
  const Rect title = title_of(frame, unit);
  return {title.x, title.bottom(), title.width,
          std::max(1, frame.bottom() - scaled(unit, gap_length) - title.bottom())};
}

Panel make_panel(const Rect& frame, float unit, double aspect) {
  return {frame, title_of(frame, unit), fit(room_of(frame, unit), aspect)};
}

Rect part(const Rect& whole, int index, int count, int gap, bool downwards) {
  Rect rect = whole;
  const int length = downwards ? whole.height : whole.width;
  const int each = std::max(1, (length - (count - 1) * gap) / count);
  (downwards ? rect.height : rect.width) = each;
  (downwards ? rect.y : rect.x) += index * (each + gap);
  return rect;
}

// Builds one layout; `body` is what marks and status bar leave.
class Plan {
public:
  Plan(int width, int height, const PictureAspects& aspects, LayoutKind kind);

  void volume();
  void b_scan();
  void microscope();
  void quad();
  Layout finish();

private:
  int length(float units) const { return scaled(layout_.unit, units); }
  bool tall() const { return body_.width < body_.height; }
  // Takes the column or the row for the small pictures off the body; what is left is returned.
  Rect take_strip(Rect& strip, double share) const;
  Rect inner(const Rect& rect) const; // without a gap all around
  void place_view(const Rect& frame);
  void place_marks_above();
  void place_b_scans(const Rect& cell);
  void place_en_face(const Rect& cell);
  void b_scan_above_crossed();
  void b_scan_beside_crossed();
  void place_b_scan(const Rect& frame);
  void place_small(const Rect& room, bool downwards);
  Rect take_head(Rect& room, double aspect, double most_share) const;
  Rect beside_large(const Rect& strip) const;

  PictureAspects aspects_;
  Layout layout_;
  Rect body_;
};

Plan::Plan(int width, int height, const PictureAspects& aspects, LayoutKind kind)
    : aspects_{aspects} {
  layout_.kind = kind;
  // Narrow pictures scale with their width, so that the status bar still fits.
  layout_.unit =
      std::min({static_cast<float>(height) / 720, static_cast<float>(width) / 1200, largest_unit});
  const int bar = std::min(length(bar_length), std::max(1, height / 3));
  layout_.status_bar = {0, height - bar, width, bar};
  body_ = {0, 0, width, std::max(1, height - bar)};
}

Rect Plan::take_strip(Rect& strip, double share) const {
  Rect rest = body_;
  strip = body_;
  if (tall()) {
    rest.height = std::max(1, body_.height - static_cast<int>(std::lround(body_.height * share)));
    strip.y = rest.bottom();
    strip.height = std::max(1, body_.bottom() - strip.y);
  } else {
    rest.width = std::max(1, body_.width - static_cast<int>(std::lround(body_.width * share)));
    strip.x = rest.right();
    strip.width = std::max(1, body_.right() - strip.x);
  }
  return rest;
}

Rect Plan::inner(const Rect& rect) const {
  const int gap = length(gap_length);
  return {rect.x + gap, rect.y + gap, std::max(1, rect.width - 2 * gap),
          std::max(1, rect.height - 2 * gap)};
}

void Plan::place_view(const Rect& frame) {
  layout_.view_frame = frame;
  layout_.view_title = title_of(frame, layout_.unit);
  layout_.view = room_of(frame, layout_.unit);
}

// Where every picture has its frame, badges lie over none of them.
void Plan::place_marks_above() {
  const int height = std::min(length(marks_length), std::max(1, body_.height / 3));
  const int margin = length(gap_length);
  layout_.marks = {body_.x + margin, body_.y + margin, std::max(1, body_.width - 2 * margin),
                   std::max(1, height - margin)};
  body_.y += height;
  body_.height = std::max(1, body_.height - height);
}

// The two crossed B-scans in one cell, where each keeps half of what one alone would have; else one.
void Plan::place_b_scans(const Rect& cell) {
  const int gap = length(gap_length);
  layout_.b_scan = make_panel(cell, layout_.unit, aspects_.b_scan);
  const double alone = area(layout_.b_scan.picture);
  for (const bool downwards : {false, true}) {
    const Panel first = make_panel(part(cell, 0, 2, gap, downwards), layout_.unit, aspects_.b_scan);
    const Panel second =
        make_panel(part(cell, 1, 2, gap, downwards), layout_.unit, aspects_.crossed);
    if (area(first.picture) < alone / 2 || area(second.picture) < alone / 2)
      continue;
    layout_.b_scan = first;
    layout_.crossed = second;
    return;
  }
}

// With the crossed B-scan beside it, where it has no place yet and would be a quarter of the other
// one's size.
void Plan::place_en_face(const Rect& cell) {
  layout_.en_face = make_panel(cell, layout_.unit, aspects_.en_face);
  if (layout_.crossed.shown())
    return;
  const int gap = length(gap_length);
  Rect own = cell;
  own.width = layout_.en_face.picture.width + 2 * gap;
  const Rect rest{own.right() + gap, cell.y, cell.right() - own.right() - gap, cell.height};
  if (rest.width < length(48))
    return;
  const Panel crossed = make_panel(rest, layout_.unit, aspects_.crossed);
  if (area(crossed.picture) < area(layout_.b_scan.picture) / 4)
    return;
  layout_.en_face = make_panel(own, layout_.unit, aspects_.en_face);
  layout_.crossed = crossed;
}

void Plan::volume() {
  layout_.kind = LayoutKind::volume;
  Rect strip;
  layout_.view = take_strip(strip, column_share);
  const int gap = length(gap_length);
  // The view reaches to the strip's panels without a gap of its own.
  Rect room{strip.x, strip.y + gap, std::max(1, strip.width - gap),
            std::max(1, strip.height - 2 * gap)};
  if (tall())
    room = inner(strip);
  layout_.legend = room;
  const int count = aspects_.has_scope ? 3 : 2;
  const auto next = [&](int index) { return part(room, index, count, gap, !tall()); };
  place_b_scans(next(0));
  place_en_face(next(1));
  if (aspects_.has_scope)
    layout_.scope = make_panel(next(2), layout_.unit, aspects_.scope);
  layout_.large = layout_.view;
  layout_.stage = layout_.view;
}

// The crossed B-scan at the head of a wider column, or below the large one: where both are larger.
void Plan::b_scan() {
  place_marks_above();
  Plan below{*this};
  below.b_scan_above_crossed();
  if (!tall())
    b_scan_beside_crossed();
  if (tall() || area(below.layout_.b_scan.picture) + area(below.layout_.crossed.picture) >
                    area(layout_.b_scan.picture) + area(layout_.crossed.picture))
    *this = below;
}

// Takes off a frame as high as its picture needs at that width, but at most that share.
Rect Plan::take_head(Rect& room, double aspect, double most_share) const {
  const int around = room.height - room_of(room, layout_.unit).height;
  const int needed =
      around + static_cast<int>(std::ceil(room_of(room, layout_.unit).width / aspect));
  Rect head = room;
  head.height = std::min(needed, static_cast<int>(room.height * most_share));
  room.y = head.bottom() + length(gap_length);
  room.height -= head.height + length(gap_length);
  return head;
}

void Plan::b_scan_above_crossed() {
  Rect strip;
  const Rect whole = inner(take_strip(strip, column_share));
  Rect rest = whole;
  const Rect head = take_head(rest, aspects_.b_scan, 0.7);
  const Panel crossed = make_panel(rest, layout_.unit, aspects_.crossed);
  const bool readable = std::min(crossed.picture.width, crossed.picture.height) >= length(48);
  if (readable)
    layout_.crossed = crossed;
  place_b_scan(readable ? head : whole);
  Rect room = beside_large(strip);
  layout_.legend = room;
  place_small(room, !tall());
}

void Plan::b_scan_beside_crossed() {
  Rect strip;
  place_b_scan(inner(take_strip(strip, wide_column_share)));
  Rect room = beside_large(strip);
  layout_.legend = room;
  layout_.crossed =
      make_panel(take_head(room, aspects_.crossed, 0.6), layout_.unit, aspects_.crossed);
  place_small(room, false);
}

void Plan::place_b_scan(const Rect& frame) {
  layout_.b_scan = make_panel(frame, layout_.unit, aspects_.b_scan);
  layout_.large = layout_.b_scan.picture;
  layout_.stage = room_of(frame, layout_.unit);
}

// A gap between large and small, not two.
Rect Plan::beside_large(const Rect& strip) const {
  Rect room = inner(strip);
  if (!tall()) {
    room.x -= length(gap_length);
    room.width += length(gap_length);
  }
  return room;
}

// Volume, en face and microscope.
void Plan::place_small(const Rect& room, bool downwards) {
  const int count = aspects_.has_scope ? 3 : 2;
  const auto next = [&](int index) {
    return part(room, index, count, length(gap_length), downwards);
  };
  place_view(next(0));
  layout_.en_face = make_panel(next(1), layout_.unit, aspects_.en_face);
  if (aspects_.has_scope)
    layout_.scope = make_panel(next(2), layout_.unit, aspects_.scope);
}

void Plan::microscope() {
  place_marks_above();
  const int gap = length(gap_length);
  const Rect whole = inner(body_);
  // As large as it can be, at the left or at the top.
  const Rect most = fit(room_of(whole, layout_.unit), aspects_.scope);
  Rect frame = whole;
  Rect free = whole;
  if (tall()) {
    frame.height = most.height + whole.height - room_of(whole, layout_.unit).height;
    free.y = frame.bottom() + gap;
    free.height = whole.bottom() - free.y;
  } else {
    frame.width = most.width + 2 * gap;
    free.x = frame.right() + gap;
    free.width = whole.right() - free.x;
  }
  const double free_share = tall() ? static_cast<double>(free.height) / whole.height
                                   : static_cast<double>(free.width) / whole.width;
  if (free_share >= 0.22) {
    layout_.legend = free;
    place_b_scans(part(free, 0, 2, gap, !tall()));
    place_view(part(free, 1, 2, gap, !tall()));
  } else {
    frame = whole;
    layout_.inset = true;
  }
  layout_.scope = make_panel(frame, layout_.unit, aspects_.scope);
  layout_.large = layout_.scope.picture;
  layout_.stage = room_of(frame, layout_.unit);
  if (layout_.inset) {
    const Rect& under = layout_.large;
    const auto share = [](int length) {
      return std::max(1, static_cast<int>(std::lround(length * inset_share)));
    };
    // As wide as a quarter allows, and half as high again as the lower quarter: still beside the
    // middle.
    const int width = std::min(under.width / 4, share(body_.width));
    const int height = std::min(under.height / 2, width * 4 / 5);
    place_view({under.right() - width, under.bottom() - std::max(1, height), std::max(1, width),
                std::max(1, height)});
  }
}

void Plan::quad() {
  place_marks_above();
  const int gap = length(gap_length);
  const Rect whole = inner(body_);
  const auto cell = [&](int column, int row) {
    return part(part(whole, column, 2, gap, false), row, 2, gap, true);
  };
  if (aspects_.has_scope) {
    place_view(cell(0, 0));
    place_b_scans(cell(1, 0));
    place_en_face(cell(0, 1));
    layout_.scope = make_panel(cell(1, 1), layout_.unit, aspects_.scope);
  } else {
    place_view(part(whole, 0, 2, gap, tall()));
    const Rect rest = part(whole, 1, 2, gap, tall());
    place_b_scans(part(rest, 0, 2, gap, !tall()));
    place_en_face(part(rest, 1, 2, gap, !tall()));
  }
  layout_.legend = aspects_.has_scope ? layout_.scope.frame : layout_.b_scan.frame;
  layout_.large = layout_.view;
  layout_.stage = layout_.view;
}

// The places of the heads-up display, in the outer quarters of the stage.
Layout Plan::finish() {
  const Rect& stage = layout_.stage;
  const int quarter_height = stage.height / 4;
  const int quarter_width = stage.width / 4;
  const int margin = std::min(length(edge), std::max(1, quarter_height / 8));

  const int echo_width = std::min(length(360), stage.width / 2);
  // A large volume has a line of text at its foot.
  const int foot = layout_.kind == LayoutKind::volume ? length(40) : margin;
  const int echo_height = std::min(length(80), std::max(0, quarter_height - foot));
  layout_.echo = {stage.x + (stage.width - echo_width) / 2, stage.bottom() - foot - echo_height,
                  echo_width, echo_height};

  // Above the echo where both fit into the lower quarter, else at the foot of a small picture.
  const int line = length(44);
  const int small_gap = length(6);
  layout_.notice = {stage.x + margin, layout_.echo.y - small_gap - line,
                    std::max(1, stage.width - quarter_width - 2 * margin), line};
  if (layout_.notice.y < stage.bottom() - quarter_height) {
    const Rect& cell = layout_.en_face.shown()  ? layout_.en_face.frame
                       : layout_.b_scan.shown() ? layout_.b_scan.frame
                                                : layout_.view_frame;
    layout_.notice = {cell.x + margin, cell.bottom() - margin - line,
                      std::max(1, cell.width - 2 * margin), line};
  }

  const int side = std::max(1, quarter_width - margin);
  const int histogram_height = std::min(length(170), std::max(1, stage.height / 3));
  layout_.histogram = {stage.right() - margin - side, stage.bottom() - foot - histogram_height,
                       side, histogram_height};

  const int cube =
      std::min({length(132), layout_.view.width / 4 - margin, layout_.view.height / 2});
  if (cube >= length(64))
    layout_.cube = {layout_.view.right() - cube - margin / 2, layout_.view.y + margin / 2, cube,
                    cube};
  if (layout_.kind == LayoutKind::volume)
    layout_.marks = {stage.x + margin, stage.y + margin,
                     std::max(1, stage.width - layout_.cube.width - 3 * margin),
                     std::max(1, quarter_height - margin)};
  if (layout_.inset) { // the volume is there
    layout_.histogram = {stage.x + margin, stage.y + margin, side, histogram_height};
    layout_.legend = {stage.x + margin, layout_.histogram.bottom() + small_gap, side,
                      std::max(0, stage.height / 2 - histogram_height)};
  }
  return layout_;
}

} // namespace

Layout lay_out(int width, int height, const PictureAspects& aspects, LayoutKind kind) {
  Plan plan{width, height, aspects, kind};
  switch (kind) {
  case LayoutKind::volume: plan.volume(); break;
  case LayoutKind::b_scan: plan.b_scan(); break;
  case LayoutKind::microscope:
    if (aspects.has_scope)
      plan.microscope();
    else
      plan.volume();
    break;
  case LayoutKind::quad: plan.quad(); break;
  }
  return plan.finish();
}

} // namespace octascope::ui
