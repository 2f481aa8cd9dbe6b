// Colours as colour-blind people see them, and how far two are apart.
#pragma once

#include <array>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "ui/canvas/palette.h"

namespace octascope::tests {

// On linear RGB, for a complete lack of one kind of cone. Source: G. Machado, M. Oliveira,
// L. Fernandes, "A physiologically-based model for simulation of color vision deficiency", IEEE
// TVCG 15 (2009), severity 1.0.
struct Vision {
  const char* name;
  glm::dmat3 rows; // each column here is a row of the paper's matrix
};

inline const std::array<Vision, 4> all_visions{
    Vision{"full", glm::dmat3{1}},
    Vision{"protanopia",
           {0.152286, 1.052583, -0.204868, 0.114503, 0.786281, 0.099216, -0.003882, -0.048116,
            1.051998}},
    Vision{"deuteranopia",
           {0.367322, 0.860646, -0.227968, 0.280085, 0.672501, 0.047413, -0.011820, 0.042940,
            0.968881}},
    Vision{"tritanopia",
           {1.255528, -0.076749, -0.178779, -0.078411, 0.930809, 0.147602, 0.004733, 0.691367,
            0.303900}}};

// CIE 1976 L*a*b* under D65 of what that eye sees of an sRGB colour, 0…1.
inline glm::dvec3 seen_lab_of_srgb(const glm::dvec3& colour, const Vision& vision) {
  const auto linear = [](double s) {
    return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
  };
  const glm::dvec3 rgb = glm::clamp(
      glm::dvec3{linear(colour.r), linear(colour.g), linear(colour.b)} * vision.rows, 0.0, 1.0);
  const glm::dvec3 xyz{glm::dot(rgb, glm::dvec3{0.4124564, 0.3575761, 0.1804375}) / 0.95047,
                       glm::dot(rgb, glm::dvec3{0.2126729, 0.7151522, 0.0721750}),
                       glm::dot(rgb, glm::dvec3{0.0193339, 0.1191920, 0.9503041}) / 1.08883};
  const auto f = [](double t) {
    return t > 216.0 / 24389 ? std::cbrt(t) : (24389.0 / 27 * t + 16) / 116;
  };
  return {116 * f(xyz.y) - 16, 500 * (f(xyz.x) - f(xyz.y)), 200 * (f(xyz.y) - f(xyz.z))};
}

inline glm::dvec3 seen_lab(ui::Colour colour, const Vision& vision) {
  return seen_lab_of_srgb(glm::dvec3{colour.r, colour.g, colour.b} / 255.0, vision);
}

inline double seen_difference(ui::Colour a, ui::Colour b, const Vision& vision) {
  return glm::distance(seen_lab(a, vision), seen_lab(b, vision));
}

} // namespace octascope::tests
