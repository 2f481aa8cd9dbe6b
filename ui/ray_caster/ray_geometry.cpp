#include "ui/ray_caster/ray_geometry.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "pipeline/volume/volume_geometry.h"

namespace octascope::ui {

RayGeometry ray_geometry(const pipeline::VolumeGeometry& g, const Camera& camera,
                         const CutAway& away) {
  const glm::vec3 per_mm{1e3 / g.depth_spacing_um, 1e3 / g.a_spacing_um, 1e3 / g.b_spacing_um};
  const glm::vec3 counts{g.depths, g.a_scans, g.b_scans};
  const glm::vec3 middle = counts / 2.0F + glm::vec3{-0.5F, 0.5F, 0.5F};
  // From the world's axes (ui/view/camera.h).
  const auto cells = [&](const glm::vec3& world) {
    return glm::vec3{-world.y, world.x, world.z} * per_mm;
  };
  RayGeometry rays;
  rays.lower = {static_cast<float>(pipeline::blank_depth_bins), 0.5F, 0.5F};
  rays.upper = {counts.x - 0.5F, counts.y + 0.5F, counts.z + 0.5F};
  rays.is_cut = !away.nothing();
  for (const int axis : {0, 1})
    rays.cut[axis] = away.has_face(axis) ? 0.5F + away.face(axis) * counts[axis + 1] : 1e9F;
  rays.eye = cells(camera.eye) + middle;
  rays.forward = cells(camera.forward);
  rays.right = cells(camera.right);
  rays.up = cells(camera.up);
  const glm::vec3 lamp = glm::normalize(0.6F * camera.up - 0.5F * camera.right - camera.forward);
  rays.mm = 1.0F / per_mm;
  rays.lamp = {-lamp.y, lamp.x, lamp.z};
  const float reach = glm::dot(glm::abs(camera.forward), box_extents_mm(g) / 2.0F);
  const float centre = camera.depth_of(glm::vec3{0});
  rays.cue_near_mm = std::max(centre - reach, camera.near_mm);
  rays.cue_per_mm = 1 / (centre + reach - rays.cue_near_mm);
  return rays;
}

unsigned octants_of_rays(const pipeline::VolumeGeometry& g, const Camera& camera) {
  const RayGeometry rays = ray_geometry(g, camera);
  const float up = camera.tan_half_height * 1.1F; // and a little: packets reach over the border
  const float right = up * camera.aspect;
  bool goes_up[3] = {}, goes_down[3] = {};
  for (const float x : {-right, right})
    for (const float y : {-up, up}) {
      const glm::vec3 d = rays.forward + (x + camera.centre_shift) * rays.right + y * rays.up;
      for (int axis = 0; axis < 3; ++axis) {
        const float level = 0.01F * glm::length(d); // nearly along the other axes: either
        goes_up[axis] |= d[axis] > -level;
        goes_down[axis] |= d[axis] < level;
      }
    }
  unsigned octants = 0;
  for (unsigned octant = 0; octant < 8; ++octant) {
    bool has_rays = true;
    for (unsigned axis = 0; axis < 3; ++axis)
      has_rays &= (octant >> axis & 1U) != 0 ? goes_up[axis] : goes_down[axis];
    octants |= has_rays ? 1U << octant : 0U;
  }
  return octants;
}

} // namespace octascope::ui
