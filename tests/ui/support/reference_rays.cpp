#include "tests/ui/support/reference_rays.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include <glm/geometric.hpp>

#include "pipeline/volume/level_scale.h"
#include "ui/dither/dither_mask.h"
#include "ui/ray_caster/ray_geometry.h"
#include "ui/transfer/flow_look.h"

namespace octascope::tests {

namespace {

using Vector = glm::dvec3;

class Reference {
public:
  Reference(const pipeline::Volume& volume, const ui::ViewState& window,
            const ui::RaySettings& settings)
      : volume_{volume}, g_{volume.geometry}, window_{window}, settings_{settings},
        extents_{g_.a_mm(), g_.depth_mm(), g_.b_mm()} {}

  ReferencePixel trace(const Vector& eye, const Vector& forward, const Vector& ray,
                       const Vector& lamp, double near, double shift) const;

private:
  double voxel(std::span<const std::uint8_t> of, int z, int a, int b) const {
    z = std::clamp(z, 0, g_.depths - 1);
    a = std::clamp(a, 0, g_.a_scans - 1);
    b = std::clamp(b, 0, g_.b_scans - 1);
    return of[static_cast<std::size_t>(b) * g_.b_scan_voxels() +
              static_cast<std::size_t>(a) * static_cast<std::size_t>(g_.depths) +
              static_cast<std::size_t>(z)];
  }
  // In millimetres around the centre, moved into the box that is shown.
  double sample(std::span<const std::uint8_t> of, Vector p) const {
    const Vector half = extents_ / 2.0;
    p.x = std::clamp(p.x, -half.x, half.x);
    p.y = std::clamp(p.y, -half.y, top());
    p.z = std::clamp(p.z, -half.z, half.z);
    const double z = (0.5 - p.y / extents_.y) * g_.depths - 0.5;
    const double a = (0.5 + p.x / extents_.x) * g_.a_scans - 0.5;
    const double b = (0.5 + p.z / extents_.z) * g_.b_scans - 0.5;
    const double fz = z - std::floor(z);
    const double fa = a - std::floor(a);
    const double fb = b - std::floor(b);
    double sum = 0;
    for (int corner = 0; corner < 8; ++corner) {
      const int dz = corner & 1;
      const int da = corner >> 1 & 1;
      const int db = corner >> 2;
      sum += (dz != 0 ? fz : 1 - fz) * (da != 0 ? fa : 1 - fa) * (db != 0 ? fb : 1 - fb) *
             voxel(of, static_cast<int>(std::floor(z)) + dz, static_cast<int>(std::floor(a)) + da,
                   static_cast<int>(std::floor(b)) + db);
    }
    return sum;
  }
  // Under the blank depths.
  double top() const { return extents_.y / 2 - 2.5 * extents_.y / g_.depths; }
  double grey(double level) const {
    const double db = static_cast<double>(pipeline::lowest_level_db) + 0.5 * level;
    return std::clamp((db - static_cast<double>(window_.window_offset_db)) /
                          static_cast<double>(window_.window_size_db),
                      0.0, 1.0);
  }
  // As ui/transfer/flow_look.h has it.
  double flow_weight(const Vector& p) const;
  double opacity_over(double opacity, double steps) const {
    return 1 - std::pow(std::max(1 - opacity, 1e-5), steps);
  }
  std::array<double, 4> texel(const Vector& p) const;
  double light(const Vector& p, const Vector& ray, const Vector& lamp) const;

  const pipeline::Volume& volume_;
  const pipeline::VolumeGeometry& g_;
  const ui::ViewState& window_;
  const ui::RaySettings& settings_;
  Vector extents_;
};

// The texel's four numbers, between its neighbours.
std::array<double, 4> Reference::texel(const Vector& p) const {
  const ui::LightVolume& light = *settings_.light;
  const std::array counts{light.counts().depth, light.counts().a, light.counts().b};
  // In the ray caster's cells: voxel 0 is at 0, 1 and 1.
  const Vector cells{(0.5 - p.y / extents_.y) * g_.depths - 0.5,
                     (0.5 + p.x / extents_.x) * g_.a_scans + 0.5,
                     (0.5 + p.z / extents_.z) * g_.b_scans + 0.5};
  std::array<double, 4> sums{};
  std::array<int, 3> below{};
  std::array<double, 3> share{};
  for (int axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<std::size_t>(axis);
    const double at = std::clamp(cells[axis] * static_cast<double>(light.texel_scale()[axis]) +
                                     static_cast<double>(light.texel_offset()[axis]),
                                 0.0, counts[i] - 1.0);
    below[i] = static_cast<int>(at);
    share[i] = at - below[i];
  }
  for (int corner = 0; corner < 8; ++corner) {
    double weight = 1;
    std::size_t index = 0;
    for (std::size_t axis = 3; axis-- > 0;) {
      const bool above = (corner >> axis & 1) != 0;
      weight *= above ? share[axis] : 1 - share[axis];
      index = index * static_cast<std::size_t>(counts[axis]) +
              static_cast<std::size_t>(std::min(below[axis] + (above ? 1 : 0), counts[axis] - 1));
    }
    for (std::size_t channel = 0; channel < 4; ++channel)
      sums[channel] += weight * (light.texels()[index] >> (8 * channel) & 0xFFU);
  }
  return {(sums[0] - 128) / 127, (sums[1] - 128) / 127, (sums[2] - 128) / 127, sums[3] / 255};
}

double Reference::light(const Vector& p, const Vector& ray, const Vector& lamp) const {
  if (settings_.light == nullptr)
    return 1;
  const auto [z, a, b, density] = texel(p);
  const Vector slope{a, -z, b}; // y runs against the depth
  const double size = glm::length(slope);
  const double side = glm::dot(slope, ray) < 0 ? -1 : 1;
  const double half = 0.5 - 0.5 * side * glm::dot(slope, lamp) / std::max(size, 1e-6);
  const double ambient = static_cast<double>(ui::ambient_light);
  const double lit = ambient + (1 - ambient) * half * half;
  const double weak = static_cast<double>(ui::weak_slope);
  const double strength = size * size / (size * size + weak * weak);
  const double level = static_cast<double>(ui::level_light);
  const double open = std::clamp(static_cast<double>(ui::open_light) - density,
                                 static_cast<double>(ui::least_open), 1.0);
  return (level + strength * (lit - level)) * open;
}

double Reference::flow_weight(const Vector& p) const {
  const auto from = static_cast<double>(ui::flow_seen_from);
  const auto to = static_cast<double>(ui::flow_seen_full);
  const double share = std::clamp((sample(volume_.flow, p) / 255 - from) / (to - from), 0.0, 1.0);
  return share * share * (3 - 2 * share);
}

std::array<double, 3> with_flow(const std::array<double, 3>& tissue, double weight) {
  const std::array wall{ui::flow_wall.red, ui::flow_wall.green, ui::flow_wall.blue};
  const std::array middle{ui::flow_middle.red, ui::flow_middle.green, ui::flow_middle.blue};
  std::array<double, 3> mixed{};
  for (std::size_t i = 0; i < mixed.size(); ++i) {
    const double flow =
        std::lerp(static_cast<double>(wall[i]), static_cast<double>(middle[i]), weight);
    mixed[i] = std::lerp(tissue[i], flow, weight);
  }
  return mixed;
}

ReferencePixel Reference::trace(const Vector& eye, const Vector& forward, const Vector& ray,
                                const Vector& lamp, double near, double shift) const {
  const double cosine = glm::dot(ray, forward);
  double from = near / cosine;
  double to = 1e9;
  const Vector low{-extents_.x / 2, -extents_.y / 2, -extents_.z / 2};
  const Vector high{extents_.x / 2, top(), extents_.z / 2};
  for (int axis = 0; axis < 3; ++axis) {
    const double a = (low[axis] - eye[axis]) / ray[axis];
    const double b = (high[axis] - eye[axis]) / ray[axis];
    from = std::max(from, std::min(a, b));
    to = std::min(to, std::max(a, b));
  }
  const double step = static_cast<double>(settings_.step_mm);
  const double steps = step / (glm::length(extents_) / 192);
  const double reach = glm::dot(glm::abs(forward), extents_ / 2.0);
  const double centre = -glm::dot(eye, forward);
  const double nearest = std::max(centre - reach, near);

  ReferencePixel pixel{0, 0, std::numeric_limits<double>::infinity(), 0, 0};
  double transparency = 1;
  double highest = -1;
  double half_of_flow = 0;
  double flowing = 0; // share of the opacity
  double powers = 0;
  double places = 0;
  for (double k = std::ceil(from / step - shift); (k + shift) * step < to; ++k) {
    const double t = (k + shift) * step;
    const Vector p = eye + t * ray;
    const double level_here = sample(volume_.levels, p);
    const double g = grey(level_here);
    const double flow = settings_.flow_opacity ? flow_weight(p) : 0;
    const double flow_opacity = flow * static_cast<double>(settings_.flow_opacity.value_or(0));
    if (settings_.mode == ui::RayMode::maximum) {
      if (level_here > highest && g > 0)
        pixel = {255 * g, 255 * g, t * cosine, 255 * g, 255 * g};
      highest = std::max(highest, level_here);
      if (flow > 0 && transparency >= 0.5)
        half_of_flow = t * cosine;
      transparency *= flow > 0 ? 1 - opacity_over(flow_opacity, steps) : 1;
      continue;
    }
    const double alpha =
        opacity_over(std::max(g * static_cast<double>(window_.opacity), flow_opacity), steps);
    const auto colour = with_flow({g, g, g}, flow);
    const double weight = transparency * alpha;
    flowing += weight * flow;
    powers += std::pow(weight, 4);
    places += std::pow(weight, 4) * t;
    pixel.grey += 255 * weight * colour[0];
    pixel.green += 255 * weight * colour[1];
    pixel.blue += 255 * weight * colour[2];
    const double after = transparency * (1 - alpha);
    if (transparency >= 0.5 && after < 0.5)
      pixel.depth_mm = t * cosine;
    transparency = after;
  }
  if (settings_.mode == ui::RayMode::shaded && powers > 1e-33) {
    const double t = places / powers;
    const double depth = (t * cosine - nearest) / (centre + reach - nearest);
    const double shade = light(eye + t * ray, ray, lamp);
    const double brightness =
        std::max({pixel.grey, pixel.green, pixel.blue}) / 255 / (1 - transparency);
    const double above = std::clamp((brightness - static_cast<double>(ui::gleam_from)) /
                                        static_cast<double>(ui::gleam_to - ui::gleam_from),
                                    0.0, 1.0);
    const double shines = std::max(above * above * (3 - 2 * above), flowing / (1 - transparency));
    const double gleam = settings_.light != nullptr ? shines : 0;
    const double lit = (shade + gleam * (1 - shade)) *
                       (1 - static_cast<double>(ui::depth_cue) * std::clamp(depth, 0.0, 1.0));
    pixel.grey *= lit;
    pixel.green *= lit;
    pixel.blue *= lit;
  }
  if (settings_.mode == ui::RayMode::maximum && transparency < 1) {
    if (transparency < 0.5 || pixel.opacity == 0)
      pixel.depth_mm = half_of_flow;
    const auto tinted =
        with_flow({pixel.grey / 255, pixel.green / 255, pixel.blue / 255}, 1 - transparency);
    pixel.grey = 255 * tinted[0];
    pixel.green = 255 * tinted[1];
    pixel.blue = 255 * tinted[2];
    pixel.opacity = std::max({pixel.grey, pixel.green, pixel.blue});
  }
  if (settings_.mode != ui::RayMode::maximum)
    pixel.opacity = 255 * (1 - transparency);
  return pixel;
}

} // namespace

std::vector<ReferencePixel> reference_rays(const pipeline::Volume& volume, const ui::Camera& camera,
                                           const ui::ViewState& window,
                                           const ui::RaySettings& settings, int width, int height) {
  const Reference reference{volume, window, settings};
  std::vector<ReferencePixel> picture;
  const double pixel_height = 2 * static_cast<double>(camera.tan_half_height) / height;
  const double pixel_width =
      2 * static_cast<double>(camera.tan_half_height) * static_cast<double>(camera.aspect) / width;
  const Vector lamp =
      glm::normalize(0.6 * Vector{camera.up} - 0.5 * Vector{camera.right} - Vector{camera.forward});
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const Vector ray =
          Vector{camera.forward} +
          ((x + 0.5 - width / 2.0) * pixel_width + static_cast<double>(camera.centre_shift)) *
              Vector{camera.right} +
          (height / 2.0 - y - 0.5) * pixel_height * Vector{camera.up};
      const int row = (height - 1 - y) % ui::dither_size;
      const double shift = static_cast<double>(
          ui::dither_mask()[static_cast<std::size_t>(row * ui::dither_size + x % ui::dither_size)]);
      picture.push_back(reference.trace(Vector{camera.eye}, Vector{camera.forward},
                                        glm::normalize(ray), lamp,
                                        static_cast<double>(camera.near_mm), shift));
    }
  return picture;
}

} // namespace octascope::tests
