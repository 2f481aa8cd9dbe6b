#include "ui/vessels/splatter/cluster_view.h"

namespace octascope::ui {

namespace {

ViewPlace between(const ViewPlace& a, const ViewPlace& b, double t) {
  const auto at = [t](double from, double to) { return from + t * (to - from); };
  return {at(a.column, b.column), at(a.line, b.line), at(a.distance_mm, b.distance_mm),
          at(a.radius_mm, b.radius_mm)};
}

ScreenPlace on_screen(const ViewPlace& place) {
  return {static_cast<float>(place.column / place.distance_mm),
          static_cast<float>(place.line / place.distance_mm),
          static_cast<float>(1 / place.distance_mm),
          static_cast<float>(std::log2(place.radius_mm))};
}

bool misses(const SplatFrame& frame, const ScreenSegment& s) {
  const auto radius_px = [&](const ScreenPlace& p) {
    return std::exp2(p.log2_radius) * p.nearness * frame.pixels_per_unit;
  };
  const float r = std::max({radius_px(s.start), radius_px(s.end), least_vessel_radius_px}) + 1e-3F;
  const auto apart = [r](float a, float b, int size) {
    return std::max(a, b) + r < -0.5F || std::min(a, b) - r > static_cast<float>(size) - 0.5F;
  };
  return apart(s.start.column, s.end.column, frame.width) ||
         apart(s.start.line, s.end.line, frame.height);
}

} // namespace

std::optional<ScreenSegment> clip_to_near(const SplatFrame& frame, const ViewPlace& parent,
                                          const ViewPlace& end) {
  const double near_mm = frame.near_mm;
  if (parent.distance_mm < near_mm && end.distance_mm < near_mm)
    return std::nullopt;
  ViewPlace a = parent;
  ViewPlace b = end;
  a.radius_mm = pipeline::segment_start_radius(static_cast<float>(parent.radius_mm),
                                               static_cast<float>(end.radius_mm));
  const double t = (near_mm - a.distance_mm) / (b.distance_mm - a.distance_mm);
  if (a.distance_mm < near_mm)
    a = between(a, b, t);
  else if (b.distance_mm < near_mm)
    b = between(a, b, t);
  const ScreenSegment s{on_screen(a), on_screen(b)};
  if (misses(frame, s))
    return std::nullopt;
  return s;
}

} // namespace octascope::ui
