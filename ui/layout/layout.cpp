#include "ui/layout/layout.h"

#include <algorithm>
#include <cmath>

namespace octascope::ui {

namespace {

constexpr double least_column = 0.27; // shares of the width
constexpr double widest_column = 0.44;
constexpr double least_en_face = 1.0 / 7; // beside a large volume
constexpr double beside_scope = 0.38;     // a large picture of fixed aspect needs more for itself
constexpr double beside_b_scan = 0.31;
constexpr double with_crossed = 0.4; // the crossed B-scan at the column's head
constexpr double view_aspect = 1.6;  // of a small volume
constexpr double row_share = 0.36;   // of the height, below what is taller than wide

// Lengths at unit 1.
constexpr float gap_length = 8;
constexpr float title_length = 34;
constexpr float bar_length = 88;
constexpr float figures_length = 68;
constexpr float timing_length = 216;
constexpr float marks_length = 62;  // one row of badges
constexpr float least_width = 1152; // that the status bar needs
constexpr float cube_length = 150;
constexpr float least_small = 160; // width of a frame whose picture's scale still fits in
constexpr float edge = 14;         // from the borders of a picture to what lies over it

double area(const Rect& rect) {
  return static_cast<double>(rect.width) * rect.height;
}

// So that neither is small.
double both_b_scans(const Layout& layout) {
  return area(layout.b_scan.picture) * area(layout.crossed.picture);
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

// Builds one layout; `body_` is what status bar, strip and badges leave.
class Plan {
public:
  Plan(int width, int height, const PictureAspects& aspects, LayoutKind kind, const Extras& extras);

  void volume();
  void b_scan();
  void microscope();
  void quad();
  Layout finish();

private:
  int length(float units) const { return scaled(layout_.unit, units); }
  bool tall() const { return body_.width < body_.height; }
  void take_marks();
  Rect take_foot(int height);
  // Takes the small pictures' room off the body; what is left is returned.
  struct Head {    // of the strip
    double aspect; // of all that is in it
    int rows = 1;
    int columns = 1;
  };
  Rect take_strip(const Head& head, double widest);
  Rect cut_off(int row, int column);
  int column_width(double widest) const;
  std::array<Rect, 3> cells() const;  // of the strip: the one on top, the two below
  Rect inner(const Rect& rect) const; // without a gap all around
  void place_view(const Rect& frame);
  void place_b_scan(const Rect& frame); // as the large picture
  void place_b_scans(const Rect& cell);
  void place_en_face(const Rect& cell);
  void choose_beside_volume();
  void volume_beside(const Head& head);
  void volume_beside_quarter();
  void take_large_view();
  void b_scan_above_crossed();
  void b_scan_beside_crossed();
  Rect take_head(Rect& room, double aspect, double most_share) const;

  PictureAspects aspects_;
  Extras extras_;
  Layout layout_;
  Rect body_;
  Rect strip_;
  Head head_{1};
};

Plan::Plan(int width, int height, const PictureAspects& aspects, LayoutKind kind,
           const Extras& extras)
    : aspects_{aspects}, extras_{extras} {
  layout_.kind = kind;
  // Narrow pictures scale with their width, so that the status bar still fits.
  layout_.unit = std::min(
      {static_cast<float>(height) / 720, static_cast<float>(width) / least_width, largest_unit});
  const int bar = std::min(length(bar_length), std::max(1, height / 3));
  layout_.status_bar = {0, height - bar, width, bar};
  layout_.notice = {0, height - bar, width, std::max(1, bar * 2 / 5)};
  body_ = {0, 0, width, std::max(1, height - bar)};
  if (extras.figures)
    layout_.figures = take_foot(length(figures_length));
  if (extras.timing)
    layout_.timing = take_foot(length(timing_length));
}

// Off the body, over its whole width; at most a third of it.
Rect Plan::take_foot(int height) {
  const int taken = std::min(height, std::max(1, body_.height / 3));
  body_.height = std::max(1, body_.height - taken);
  return {0, body_.bottom(), body_.width, taken};
}

// Where every picture has its frame, badges lie over none of them.
void Plan::take_marks() {
  const int height = std::min(length(marks_length), std::max(1, body_.height / 3));
  const int margin = length(gap_length);
  layout_.marks = {body_.x + margin, body_.y + margin, std::max(1, body_.width - 2 * margin),
                   std::max(1, height - margin)};
  body_.y += height;
  body_.height = std::max(1, body_.height - height);
}

// As wide as lets the one on top and the two below it fill the height.
int Plan::column_width(double widest) const {
  const int gap = length(gap_length);
  const int title = length(title_length);
  const double below =
      aspects_.has_scope ? 2 * std::min(aspects_.en_face, aspects_.scope) : aspects_.en_face;
  const double pictures =
      body_.height - 3.0 * gap - 2.0 * (title + gap) - (head_.rows - 1.0) * (title + 2 * gap);
  return static_cast<int>(
      std::lround(std::clamp(pictures / (1 / head_.aspect + 1 / below) + 4 * gap,
                             least_column * body_.width, widest * body_.width)));
}

Rect Plan::take_strip(const Head& head, double widest) {
  head_ = head;
  return cut_off(static_cast<int>(std::lround(body_.height * row_share)), column_width(widest));
}

// So much below what is taller than wide, or beside what is not.
Rect Plan::cut_off(int row, int column) {
  Rect rest = body_;
  strip_ = body_;
  if (tall()) {
    rest.height = std::max(1, body_.height - row);
    strip_.y = rest.bottom();
    strip_.height = std::max(1, body_.bottom() - strip_.y);
  } else {
    rest.width = std::max(1, body_.width - column);
    strip_.x = rest.right();
    strip_.width = std::max(1, body_.right() - strip_.x);
  }
  strip_ = inner(strip_);
  if (extras_.legend)
    layout_.legend = strip_;
  return rest;
}

std::array<Rect, 3> Plan::cells() const {
  const int gap = length(gap_length);
  if (tall()) {
    const int count = aspects_.has_scope ? 3 : 2;
    return {part(strip_, 0, count, gap, false), part(strip_, 1, count, gap, false),
            part(strip_, count - 1, count, gap, false)};
  }
  const int over = length(title_length) + gap;
  const double wide = std::max(1, strip_.width - 2 * gap);
  const double each = aspects_.has_scope ? wide / 2 - gap : wide;
  const int third = (strip_.height - 2 * gap) / 3;
  if (aspects_.has_scope && head_.rows == 1 &&
      std::min<double>(third - over, wide) > each / aspects_.en_face)
    return {part(strip_, 0, 3, gap, true), part(strip_, 1, 3, gap, true),
            part(strip_, 2, 3, gap, true)}; // the column is narrow
  // Heights as their pictures need for the column's width.
  const double upper = wide / head_.aspect + head_.rows * over + (head_.rows - 1) * gap;
  const double lower =
      each / (aspects_.has_scope ? std::min(aspects_.en_face, aspects_.scope) : aspects_.en_face) +
      over;
  Rect top = strip_;
  top.height =
      std::max(1, static_cast<int>(std::lround((strip_.height - gap) * upper / (upper + lower))));
  Rect row = strip_;
  row.y = top.bottom() + gap;
  row.height = std::max(1, strip_.bottom() - row.y);
  const int count = aspects_.has_scope ? 2 : 1;
  return {top, part(row, 0, count, gap, false), part(row, count - 1, count, gap, false)};
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

void Plan::place_b_scan(const Rect& frame) {
  layout_.b_scan = make_panel(frame, layout_.unit, aspects_.b_scan);
  layout_.large = layout_.b_scan.picture;
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

// Both B-scans at the column's head, one over the other or side by side, or the crossed one a quarter as
// large below: whichever makes them larger and leaves the en face its size. One alone in a picture that
// is taller than wide.
void Plan::volume() {
  choose_beside_volume();
  if (extras_.legend) // in their place: the volume stays where it is
    for (Panel* panel : {&layout_.b_scan, &layout_.crossed, &layout_.en_face, &layout_.scope})
      *panel = {};
}

void Plan::choose_beside_volume() {
  if (tall()) {
    volume_beside({aspects_.b_scan});
    return;
  }
  Plan over{*this};
  over.volume_beside({1 / (1 / aspects_.b_scan + 1 / aspects_.crossed), 2});
  Plan below{*this};
  below.volume_beside_quarter();
  volume_beside({aspects_.b_scan + aspects_.crossed, 1, 2});
  for (const Plan& other : {over, below})
    if (other.layout_.en_face.picture.width >= least_en_face * body_.width &&
        both_b_scans(other.layout_) > both_b_scans(layout_))
      *this = other;
}

void Plan::take_large_view() {
  layout_.kind = LayoutKind::volume;
  layout_.large = layout_.view;
  const int margin = std::min(length(edge), std::max(1, layout_.view.height / 32));
  layout_.marks = {layout_.view.x + margin, layout_.view.y + margin,
                   std::max(1, layout_.view.width - 2 * margin),
                   std::max(1, layout_.view.height / 4 - margin)};
}

// The crossed B-scan as wide as the en face beside it, over the microscope.
void Plan::volume_beside_quarter() {
  constexpr double scope_share = 0.35; // of the column's width that the microscope's height is for
  const int gap = length(gap_length);
  const double rows = aspects_.has_scope ? 3 : 2;
  const double pictures = body_.height - (rows + 1) * gap - rows * (length(title_length) + gap);
  const double needed = 1 / aspects_.b_scan + 0.5 / aspects_.crossed +
                        (aspects_.has_scope ? scope_share / aspects_.scope : 0);
  const double column =
      std::clamp(pictures / needed + 4 * gap, 2 * least_en_face * body_.width + 8 * gap,
                 widest_column * body_.width);
  layout_.view = cut_off(0, static_cast<int>(std::lround(column)));
  take_large_view();
  Rect rest = strip_;
  layout_.b_scan =
      make_panel(take_head(rest, aspects_.b_scan, 0.55), layout_.unit, aspects_.b_scan);
  Rect left = part(rest, 0, 2, gap, false);
  layout_.en_face = make_panel(part(rest, 1, 2, gap, false), layout_.unit, aspects_.en_face);
  const Rect crossed = aspects_.has_scope ? take_head(left, aspects_.crossed, 0.6) : left;
  layout_.crossed = make_panel(crossed, layout_.unit, aspects_.crossed);
  if (aspects_.has_scope)
    layout_.scope = make_panel(left, layout_.unit, aspects_.scope);
}

void Plan::volume_beside(const Head& head) {
  layout_.view = take_strip(head, widest_column);
  take_large_view();
  const auto [top, left, right] = cells();
  if (head.rows * head.columns == 1) {
    place_b_scans(top);
  } else {
    const int gap = length(gap_length);
    const bool over = head.rows == 2;
    layout_.b_scan = make_panel(part(top, 0, 2, gap, over), layout_.unit, aspects_.b_scan);
    layout_.crossed = make_panel(part(top, 1, 2, gap, over), layout_.unit, aspects_.crossed);
  }
  place_en_face(left);
  if (aspects_.has_scope)
    layout_.scope = make_panel(right, layout_.unit, aspects_.scope);
}

// The crossed B-scan at the head of a wider column, or below the large one, whichever makes the two
// larger.
void Plan::b_scan() {
  take_marks();
  if (extras_.legend) {
    place_b_scan(inner(take_strip({view_aspect}, beside_b_scan)));
    return;
  }
  Plan below{*this};
  below.b_scan_above_crossed();
  const bool wide = body_.width * with_crossed / 3 > length(least_small);
  if (!tall() && wide)
    b_scan_beside_crossed();
  if (tall() || !wide || both_b_scans(below.layout_) > both_b_scans(layout_))
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
  const Rect whole = inner(take_strip({view_aspect}, beside_b_scan));
  Rect rest = whole;
  const Rect head = take_head(rest, aspects_.b_scan, 0.7);
  const Panel crossed = make_panel(rest, layout_.unit, aspects_.crossed);
  const bool readable = std::min(crossed.picture.width, crossed.picture.height) >= length(48);
  if (readable)
    layout_.crossed = crossed;
  place_b_scan(readable ? head : whole);
  const auto [top, left, right] = cells();
  place_view(top);
  layout_.en_face = make_panel(left, layout_.unit, aspects_.en_face);
  if (aspects_.has_scope)
    layout_.scope = make_panel(right, layout_.unit, aspects_.scope);
}

void Plan::b_scan_beside_crossed() {
  const int gap = length(gap_length);
  place_b_scan(inner(cut_off(0, static_cast<int>(std::lround(body_.width * with_crossed)))));
  layout_.crossed =
      make_panel(take_head(strip_, aspects_.crossed, 0.6), layout_.unit, aspects_.crossed);
  const int count = aspects_.has_scope ? 3 : 2;
  place_view(part(strip_, 0, count, gap, false));
  layout_.en_face = make_panel(part(strip_, 1, count, gap, false), layout_.unit, aspects_.en_face);
  if (aspects_.has_scope)
    layout_.scope = make_panel(part(strip_, 2, count, gap, false), layout_.unit, aspects_.scope);
}

void Plan::microscope() {
  take_marks();
  const Rect rest = take_strip({aspects_.b_scan}, beside_scope);
  layout_.scope = make_panel(inner(rest), layout_.unit, aspects_.scope);
  layout_.large = layout_.scope.picture;
  if (extras_.legend)
    return;
  const auto [top, left, right] = cells();
  place_b_scans(top);
  layout_.en_face = make_panel(left, layout_.unit, aspects_.en_face);
  place_view(right);
}

void Plan::quad() {
  take_marks();
  const int gap = length(gap_length);
  const Rect whole = inner(body_);
  const auto cell = [&](int column, int row) {
    return part(part(whole, column, 2, gap, false), row, 2, gap, true);
  };
  Rect legend = part(whole, 1, 2, gap, false); // two of the four
  if (aspects_.has_scope) {
    place_view(cell(0, 0));
    place_b_scans(cell(1, 0));
    place_en_face(cell(0, 1));
    layout_.scope = make_panel(cell(1, 1), layout_.unit, aspects_.scope);
  } else {
    place_view(part(whole, 0, 2, gap, tall()));
    const Rect rest = part(whole, 1, 2, gap, tall());
    legend = rest;
    place_b_scans(part(rest, 0, 2, gap, !tall()));
    place_en_face(part(rest, 1, 2, gap, !tall()));
  }
  layout_.large = layout_.view;
  if (!extras_.legend)
    return;
  layout_.legend = legend;
  for (Panel* panel : {&layout_.b_scan, &layout_.crossed, &layout_.en_face, &layout_.scope})
    if (panel->frame.x >= legend.x && panel->frame.y >= legend.y)
      *panel = {};
}

// The places of the heads-up display over the pictures, in their outer quarters.
Layout Plan::finish() {
  const Rect& large = layout_.large;
  const int margin = std::min(length(edge), std::max(1, large.height / 32));
  const int side = std::max(1, large.width / 4 - margin);
  const int height = std::min(length(170), std::max(1, large.height / 3));
  layout_.histogram = {large.right() - margin - side, large.bottom() - margin - height, side,
                       height};
  // Under the badges of a large volume.
  const Rect& view = layout_.view;
  const int down = layout_.kind == LayoutKind::volume ? view.height / 4 : 0;
  const int cube = std::min({length(cube_length), view.width / 4, view.height / 2});
  if (cube >= length(96))
    layout_.cube = {view.right() - cube, view.y + down, cube, cube};
  return layout_;
}

} // namespace

Layout lay_out(int width, int height, const PictureAspects& aspects, LayoutKind kind,
               const Extras& extras) {
  Plan plan{width, height, aspects, kind, extras};
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
