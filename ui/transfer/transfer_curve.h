// Opacity across the display window.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "hal/result.h"

namespace octascope::ui {

// At u, a place in the window: 0 at its offset, 1 at its upper end.
struct CurvePoint {
  float u = 0;
  float opacity = 0;
};

// Immutable. Any thread. opacity() allocates nothing.
class TransferCurve {
public:
  static constexpr std::size_t most_points = 64;
  static constexpr std::size_t most_entries = 4096;

  // The paper's formula (1): opacity = u.
  static TransferCurve ramp();

  // 2 to 64 points, u rising, all within 0…1; otherwise ErrorCode::invalid_argument. Constant
  // before the first and after the last point.
  static hal::Result<TransferCurve> piecewise(std::span<const CurvePoint> points);
  // A cubic Hermite spline that is monotone between its points, so that it never leaves their range
  // (F. N. Fritsch, R. E. Carlson, "Monotone piecewise cubic interpolation", SIAM Journal on
  // Numerical Analysis 17, 1980).
  static hal::Result<TransferCurve> spline(std::span<const CurvePoint> points);
  // 2 to 4096 opacities, evenly spread over the window; linear between them.
  static hal::Result<TransferCurve> table(std::span<const float> opacities);

  // u is clamped to 0…1.
  float opacity(float u) const;
  bool is_ramp() const { return knots_.empty(); }

private:
  struct Knot {
    float u;
    float opacity;
    float slope; // of the spline
  };
  TransferCurve() = default;

  std::vector<Knot> knots_;
  bool cubic_ = false;
};

} // namespace octascope::ui
