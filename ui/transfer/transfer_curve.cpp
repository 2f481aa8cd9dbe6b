#include "ui/transfer/transfer_curve.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <fmt/format.h>

namespace octascope::ui {

namespace {

bool within_unit(float value) {
  return value >= 0 && value <= 1; // false for what is not a number, too
}

hal::Result<> check(std::span<const CurvePoint> points) {
  const auto refuse = [](std::string message) {
    return hal::fail(hal::ErrorCode::invalid_argument, std::move(message));
  };
  if (points.size() < 2 || points.size() > TransferCurve::most_points)
    return refuse(fmt::format("found {} points, expected 2 to {}", points.size(),
                              TransferCurve::most_points));
  for (std::size_t i = 0; i < points.size(); ++i) {
    const CurvePoint& point = points[i];
    if (!within_unit(point.u) || !within_unit(point.opacity))
      return refuse(fmt::format("point {} is [{}, {}], expected [u, opacity], both from 0 to 1",
                                i + 1, point.u, point.opacity));
    if (i > 0 && point.u <= points[i - 1].u)
      return refuse(fmt::format("point {} is at u = {}, expected u to rise from point to point, "
                                "here beyond {}",
                                i + 1, point.u, points[i - 1].u));
  }
  return {};
}

} // namespace

TransferCurve TransferCurve::ramp() {
  return {};
}

hal::Result<TransferCurve> TransferCurve::piecewise(std::span<const CurvePoint> points) {
  HAL_CHECK(check(points));
  TransferCurve curve;
  for (const CurvePoint& point : points)
    curve.knots_.push_back({point.u, point.opacity, 0});
  return curve;
}

hal::Result<TransferCurve> TransferCurve::spline(std::span<const CurvePoint> points) {
  auto curve = piecewise(points);
  if (!curve)
    return curve;
  curve->cubic_ = true;
  std::vector<Knot>& knots = curve->knots_;
  const std::size_t segments = knots.size() - 1;
  std::vector<float> secant(segments);
  for (std::size_t i = 0; i < segments; ++i)
    secant[i] = (knots[i + 1].opacity - knots[i].opacity) / (knots[i + 1].u - knots[i].u);
  for (std::size_t i = 0; i <= segments; ++i) { // level where the points turn
    const float before = secant[i > 0 ? i - 1 : 0];
    const float after = secant[i < segments ? i : segments - 1];
    knots[i].slope = before * after <= 0 ? 0 : (before + after) / 2;
  }
  // Within a circle of radius 3 around 0, the two slopes over their secant make a monotone piece.
  for (std::size_t i = 0; i < segments; ++i) {
    if (secant[i] == 0) {
      knots[i].slope = knots[i + 1].slope = 0;
      continue;
    }
    const float excess = std::hypot(knots[i].slope / secant[i], knots[i + 1].slope / secant[i]) / 3;
    if (excess > 1) {
      knots[i].slope /= excess;
      knots[i + 1].slope /= excess;
    }
  }
  return curve;
}

hal::Result<TransferCurve> TransferCurve::table(std::span<const float> opacities) {
  if (opacities.size() < 2 || opacities.size() > most_entries)
    return hal::fail(hal::ErrorCode::invalid_argument, "found {} entries, expected 2 to {}",
                     opacities.size(), most_entries);
  TransferCurve curve;
  const auto last = static_cast<float>(opacities.size() - 1);
  for (std::size_t i = 0; i < opacities.size(); ++i) {
    if (!within_unit(opacities[i]))
      return hal::fail(hal::ErrorCode::invalid_argument,
                       "the opacity of entry {} is {}, expected 0 to 1", i + 1, opacities[i]);
    curve.knots_.push_back({static_cast<float>(i) / last, opacities[i], 0});
  }
  return curve;
}

float TransferCurve::opacity(float u) const {
  u = std::clamp(u, 0.0F, 1.0F);
  if (is_ramp())
    return u;
  if (u <= knots_.front().u)
    return knots_.front().opacity;
  if (u >= knots_.back().u)
    return knots_.back().opacity;
  const auto above = std::ranges::upper_bound(knots_, u, {}, &Knot::u);
  const Knot& low = *(above - 1);
  const Knot& high = *above;
  const float width = high.u - low.u;
  const float t = (u - low.u) / width;
  if (!cubic_)
    return std::lerp(low.opacity, high.opacity, t);
  const float t2 = t * t;
  const float t3 = t2 * t;
  const float value = (2 * t3 - 3 * t2 + 1) * low.opacity + (t3 - 2 * t2 + t) * width * low.slope +
                      (3 * t2 - 2 * t3) * high.opacity + (t3 - t2) * width * high.slope;
  // The curve stays between its knots; rounding need not.
  return std::clamp(value, std::min(low.opacity, high.opacity),
                    std::max(low.opacity, high.opacity));
}

} // namespace octascope::ui
