#include "sim/phantoms/phantom_anterior_eye.h"

#include <cmath>
#include <numbers>

#include "sim/spectrometer/noise.h"

namespace octascope::sim {
namespace {

constexpr float pi = std::numbers::pi_v<float>;
constexpr float iris_thickness_mm = 0.38F;
constexpr float scleral_slope = 0.72F;

// Depth of a sphere's cap below its apex.
float sag_mm(float radius_mm, float r_mm) {
  return radius_mm - std::sqrt(radius_mm * radius_mm - r_mm * r_mm);
}

// A mirror's return from a slope: light that leaves the lens' aperture is lost.
float specular(float peak_counts, float radius_mm, float r_mm) {
  const float slope = r_mm / radius_mm;
  return peak_counts * std::exp(-slope * slope / (2 * 0.06F * 0.06F));
}

// The iris is rounded towards the pupil.
float iris_rounding_mm(float r_mm) {
  const float edge = std::min((r_mm - AnteriorEye::pupil_mm) / 0.25F, 1.0F);
  return 0.15F * (1 - std::sqrt(edge * (2 - edge)));
}

InstrumentPath forceps_path() {
  InstrumentPath path;
  path.hinge = {4.9F, 1.9F, 2.2F};
  path.tip = {0.2F, 0.25F, 2.65F};
  path.reach = {0.55F, 0.35F, 0.12F};
  path.shaft_radius_mm = 0.26F;
  path.prong_radius_mm = 0.1F;
  path.prong_length_mm = 1.9F;
  path.opening_mm = 0.9F;
  return path;
}

std::vector<VesselSegment> radial_vessels(float axis_x_mm, float limbus_mm, std::uint64_t seed) {
  std::vector<VesselSegment> segments;
  constexpr std::uint64_t roots = 14;
  for (std::uint64_t i = 0; i < roots; ++i) {
    const float angle =
        2 * pi * (static_cast<float>(i) + 0.5F * static_cast<float>(unit_interval(hash(seed, i)))) /
        roots;
    const VesselPoint root{axis_x_mm + (limbus_mm - 0.2F) * std::cos(angle),
                           (limbus_mm - 0.2F) * std::sin(angle), 0.13F};
    const auto tree = grow_vessels(root, angle + pi, 0.075F, 1.5F, hash(seed, i, 1));
    segments.insert(segments.end(), tree.begin(), tree.end());
  }
  return segments;
}

std::vector<VesselSegment> limbal_vessels(float axis_x_mm, float limbus_mm, std::uint64_t seed) {
  std::vector<VesselSegment> segments;
  constexpr std::uint64_t roots = 26;
  for (std::uint64_t i = 0; i < roots; ++i) {
    const float angle =
        2 * pi * (static_cast<float>(i) + 0.6F * static_cast<float>(unit_interval(hash(seed, i)))) /
        roots;
    const float reach = limbus_mm + 2.6F;
    const VesselPoint root{axis_x_mm + reach * std::cos(angle), reach * std::sin(angle), 0.12F};
    const auto tree = grow_vessels(root, angle + pi, 0.085F, 1.1F, hash(seed, i, 2));
    segments.insert(segments.end(), tree.begin(), tree.end());
  }
  // The arcades end at the clear cornea.
  std::erase_if(segments, [&](const VesselSegment& s) {
    return std::hypot(s.to.x_mm - axis_x_mm, s.to.y_mm) < limbus_mm - 0.15F;
  });
  return segments;
}

} // namespace

AnteriorEye::AnteriorEye(std::uint64_t seed)
    : seed_(hash(seed, 0xe7e)), forceps_(forceps_path()),
      iris_vessels_(radial_vessels(axis_x_mm, limbus_mm, hash(seed_, 1))),
      limbal_vessels_(limbal_vessels(axis_x_mm, limbus_mm, hash(seed_, 2))) {}

pipeline::ScanPlan AnteriorEye::suggested_plan() const {
  pipeline::ScanPlan plan;
  plan.depth_spacing_um = 9;
  plan.a_spacing_um = 32;
  plan.b_spacing_um = 115;
  return plan;
}

float AnteriorEye::cornea_front_mm(float r_mm) {
  // The sclera goes on where the cornea ends, flatter.
  if (r_mm > limbus_mm)
    return apex_mm + sag_mm(7.8F, limbus_mm) + scleral_slope * (r_mm - limbus_mm);
  return apex_mm + sag_mm(7.8F, r_mm);
}

float AnteriorEye::cornea_back_mm(float r_mm) {
  return apex_mm + 0.54F + sag_mm(6.9F, r_mm);
}

float AnteriorEye::lens_front_mm(float r_mm) {
  return apex_mm + 2.95F + sag_mm(10, r_mm);
}

float AnteriorEye::iris_front_mm(float r_mm) {
  const float t = (r_mm - pupil_mm) / (limbus_mm - pupil_mm);
  return apex_mm + 2.82F + 0.4F * t - 0.12F * std::sin(pi * t);
}

// Radial folds and crypts, and the collarette, a ring at a third of the way out.
float AnteriorEye::iris_fold(float x_mm, float y_mm, float r_mm) const {
  // The noise runs along a circle of its own, so that it closes.
  const float winding = 0.08F * smooth_noise(seed_ + 4, x_mm * 0.8F, y_mm * 0.8F);
  const float along_x = ((x_mm - axis_x_mm) - winding * y_mm) / r_mm;
  const float along_y = (y_mm + winding * (x_mm - axis_x_mm)) / r_mm;
  const float fibres = 0.65F * smooth_noise(seed_ + 3, 15 * along_x, 15 * along_y, 0.9F * r_mm) +
                       0.35F * smooth_noise(seed_ + 5, 33 * along_x, 33 * along_y, 1.7F * r_mm);
  const float ring = (r_mm - pupil_mm - 1.05F) / 0.28F;
  return 0.09F * fibres - 0.10F * std::exp(-ring * ring);
}

void AnteriorEye::fill(Column& column, double phase, float x_mm, float y_mm) const {
  column.clear();
  const float r_mm = std::hypot(x_mm - axis_x_mm, y_mm);
  if (r_mm < limbus_mm)
    fill_cornea(column, r_mm);
  if (r_mm > limbus_mm - 0.5F)
    fill_sclera(column, x_mm, y_mm, r_mm);
  if (r_mm > pupil_mm && r_mm < limbus_mm)
    fill_iris(column, x_mm, y_mm, r_mm);
  if (r_mm < pupil_mm + 1) {
    const float lens = lens_front_mm(r_mm);
    column.add(Layer{lens, lens + 0.03F, 17, 0.2F});
    column.add(Layer{lens + 0.03F, 20, 4.5F, 0.45F, Grain::lamellae, 0.5F});
    column.add(Surface{lens, specular(170, 10, r_mm), 1});
  }
  Instrument::fill(column, forceps_.pose(phase), x_mm, y_mm);
}

void AnteriorEye::fill_cornea(Column& column, float r_mm) const {
  const float front = cornea_front_mm(r_mm);
  const float back = cornea_back_mm(r_mm);
  column.add(Layer{front, front + 0.05F, 13, 0.25F});
  column.add(Layer{front + 0.05F, front + 0.066F, 19, 0.25F}); // Bowman's layer
  column.add(Layer{front + 0.066F, back - 0.018F, 9.5F, 0.3F, Grain::lamellae, 0.45F});
  column.add(Layer{back - 0.018F, back, 15, 0.3F});
  column.add(Surface{front, specular(280, 7.8F, r_mm) + 16, 1});
  column.add(Surface{back, specular(90, 6.9F, r_mm) + 5, 1});
}

void AnteriorEye::fill_sclera(Column& column, float x_mm, float y_mm, float r_mm) const {
  // White tissue fades into the clear cornea over half a millimetre, deep layers first.
  const float front = cornea_front_mm(r_mm);
  const float inward = std::max(limbus_mm - r_mm, 0.0F) / 0.5F;
  const float top = front + 0.07F + 0.45F * inward;
  const float deepest = front + 1.0F;
  const float white = 1 - inward;
  if (r_mm >= limbus_mm)
    column.add(Layer{front, top, 14, 0.4F}); // conjunctiva
  column.add(Layer{top, deepest, 10 + 14 * white, 0.4F + 2.2F * white, Grain::granules, 0.4F});
  if (r_mm >= limbus_mm)
    column.add(Surface{front, 20, 1});
  limbal_vessels_.fill(column, x_mm, y_mm, front, deepest,
                       Layer{.backscatter_counts = 48, .attenuation_per_mm = 3.5F});
}

float AnteriorEye::iris_top_mm(float x_mm, float y_mm, float r_mm) const {
  const float edge = std::min((r_mm - pupil_mm) / 0.25F, 1.0F);
  return iris_front_mm(r_mm) + iris_fold(x_mm, y_mm, r_mm) * edge + iris_rounding_mm(r_mm);
}

void AnteriorEye::fill_iris(Column& column, float x_mm, float y_mm, float r_mm) const {
  const float fold = iris_fold(x_mm, y_mm, r_mm);
  const float front = iris_top_mm(x_mm, y_mm, r_mm);
  const float back = iris_front_mm(r_mm) + iris_thickness_mm - iris_rounding_mm(r_mm);
  const float anterior = 24 - 70 * std::clamp(fold, -0.2F, 0.2F);
  column.add(Layer{front, front + 0.05F, anterior, 1.2F});
  column.add(Layer{front + 0.05F, back - 0.06F, 17, 1.9F, Grain::granules, 0.6F});
  iris_vessels_.fill(column, x_mm, y_mm, front, back - 0.06F,
                     Layer{.backscatter_counts = 40, .attenuation_per_mm = 3});
  column.add(Layer{back - 0.06F, back, 34, 14}); // pigment: little comes through
}

std::vector<VesselSegment> AnteriorEye::vessels() const {
  std::vector<VesselSegment> placed;
  const auto from_axis = [](float x_mm, float y_mm) { return std::hypot(x_mm - axis_x_mm, y_mm); };
  append_below(placed, iris_vessels_, [&](float x_mm, float y_mm) -> std::optional<float> {
    const float r_mm = from_axis(x_mm, y_mm);
    if (r_mm <= pupil_mm || r_mm >= limbus_mm)
      return std::nullopt;
    return iris_top_mm(x_mm, y_mm, r_mm);
  });
  append_below(placed, limbal_vessels_, [&](float x_mm, float y_mm) -> std::optional<float> {
    return cornea_front_mm(from_axis(x_mm, y_mm));
  });
  return placed;
}

Look AnteriorEye::look(float x_mm, float y_mm) const {
  constexpr Rgb pupil{0.045F, 0.03F, 0.035F};
  constexpr Rgb blue{0.33F, 0.47F, 0.56F};
  constexpr Rgb amber{0.55F, 0.42F, 0.24F};
  constexpr Rgb sclera{0.90F, 0.85F, 0.80F};
  constexpr Rgb blood{0.66F, 0.12F, 0.10F};
  const float r_mm = std::hypot(x_mm - axis_x_mm, y_mm);
  if (r_mm > limbus_mm) {
    const float vessel = limbal_vessels_.visibility(x_mm, y_mm, 0.3F);
    const float haze = std::exp(-(r_mm - limbus_mm) / 0.35F);
    const float blush = 0.5F + 0.5F * rough_noise(seed_ + 6, x_mm * 0.6F, y_mm * 0.6F);
    const Rgb white = mix(sclera, Rgb{0.86F, 0.62F, 0.56F}, 0.30F * blush);
    return {mix(mix(white, blue, 0.55F * haze), blood, 0.8F * vessel),
            -cornea_front_mm(r_mm) + 0.03F * vessel, 0.25F};
  }
  // Through the cornea one sees the iris, but the lamp's image is the cornea's.
  const float gloss = 1;
  if (r_mm < pupil_mm)
    return {pupil, -cornea_front_mm(r_mm), gloss};
  const float fold = iris_fold(x_mm, y_mm, r_mm);
  const float inner = std::exp(-(r_mm - pupil_mm) / 0.7F);
  Rgb iris = mix(blue, amber, 0.75F * inner);
  const float shade = std::clamp(0.78F - 3.0F * fold, 0.25F, 1.3F);
  iris = {iris.r * shade, iris.g * shade, iris.b * shade};
  const float dark_ring = std::exp(-std::pow((limbus_mm - r_mm) / 0.35F, 2.0F)) * 0.6F;
  const float pupil_edge = std::exp(-(r_mm - pupil_mm) / 0.07F);
  iris = mix(mix(iris, Rgb{0.10F, 0.13F, 0.17F}, dark_ring), Rgb{0.16F, 0.09F, 0.05F}, pupil_edge);
  return {mix(iris, blood, 0.25F * iris_vessels_.visibility(x_mm, y_mm, 0.2F)),
          -cornea_front_mm(r_mm), gloss};
}

} // namespace octascope::sim
