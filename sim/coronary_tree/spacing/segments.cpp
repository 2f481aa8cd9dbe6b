#include "sim/coronary_tree/spacing/segments.h"

namespace octascope::sim {

Approach nearest_approach(const Line& a, const Line& b) {
  const Vector3 u = a.to - a.from;
  const Vector3 v = b.to - b.from;
  const Vector3 r = a.from - b.from;
  const double uu = dot(u, u);
  const double vv = dot(v, v);
  const double uv = dot(u, v);
  const double ur = dot(u, r);
  const double vr = dot(v, r);
  const double area = uu * vv - uv * uv;
  const auto within = [](double part, double whole) {
    return whole > 0 ? std::clamp(part / whole, 0.0, 1.0) : 0.0;
  };
  double s = area > 1e-12 * uu * vv ? within(uv * vr - ur * vv, area) : 0.0;
  const double t = within(uv * s + vr, vv);
  s = within(uv * t - ur, uu);
  return {s, t, r + s * u - t * v};
}

bool near_along_tree(const pipeline::VesselTree& tree, std::uint32_t a, std::uint32_t b,
                     double near_mm) {
  constexpr int always_near = 2; // segments
  const std::uint32_t ends[2] = {a, b};
  double way = 0;
  int between = 0;
  // Parents come before children: of two segments only the later one may spring from the other.
  while (a != b) {
    std::uint32_t& later = a > b ? a : b;
    if (tree.parents[later] == pipeline::no_parent)
      return false;
    if (later != ends[0] && later != ends[1]) {
      const Line line = segment_line(tree, later);
      way += length(line.to - line.from);
      if (++between > always_near && way > near_mm)
        return false;
    }
    later = tree.parents[later];
  }
  return true;
}

} // namespace octascope::sim
