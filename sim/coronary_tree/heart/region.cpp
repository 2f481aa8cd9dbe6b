#include "sim/coronary_tree/heart/region.h"

namespace octascope::sim {

Vector3 centre_of(std::span<const Vector3> places) {
  Vector3 sum;
  for (const Vector3& p : places)
    sum = sum + p;
  return places.empty() ? sum : (1 / static_cast<double>(places.size())) * sum;
}

Vector3 longest_axis(std::span<const Vector3> places, Vector3 centre, Vector3 flat) {
  double xx = 0, yy = 0, zz = 0, xy = 0, xz = 0, yz = 0;
  for (const Vector3& p : places) {
    const Vector3 d = across(p - centre, flat);
    xx += d.x * d.x;
    yy += d.y * d.y;
    zz += d.z * d.z;
    xy += d.x * d.y;
    xz += d.x * d.z;
    yz += d.y * d.z;
  }
  // The covariance matrix applied again and again turns any vector to its longest axis.
  Vector3 axis = xx > yy ? (xx > zz ? Vector3{xx, xy, xz} : Vector3{xz, yz, zz})
                         : (yy > zz ? Vector3{xy, yy, yz} : Vector3{xz, yz, zz});
  for (int i = 0; i < 5; ++i) {
    axis = unit(axis, {1, 0, 0});
    axis = {xx * axis.x + xy * axis.y + xz * axis.z, xy * axis.x + yy * axis.y + yz * axis.z,
            xz * axis.x + yz * axis.y + zz * axis.z};
  }
  return unit(axis, {1, 0, 0});
}

void divide(Region region, std::size_t count, Vector3 direction, Vector3 flat) {
  const Vector3 axis = longest_axis(region, centre_of(region), flat);
  const Vector3 onward = dot(axis, direction) < 0 ? -1.0 * axis : axis;
  lowest_first(region, count, [&](const Vector3& p) { return dot(p, onward); });
}

} // namespace octascope::sim
