// What an instrument looks at while it is set up: nothing, a mirror at either of two depths, a
// target.
#pragma once

#include "sim/phantoms/phantom.h"

namespace octascope::sim {

enum class BenchSubject : std::uint8_t {
  dark,        // the sample arm is blocked: the reference arm's light alone
  mirror_near, // level, so that the mean of many lines keeps its fringe
  mirror_far,
  target, // pipeline/calibration_finder/target.h, upright and in the middle; tilted, as a level one
          // is taken for background
};

class BenchPhantom final : public Phantom {
public:
  explicit BenchPhantom(BenchSubject subject) : subject_(subject) {}

  static constexpr float mirror_near_mm = 0.35F;
  static constexpr float mirror_far_mm = 0.98F;

  std::string_view name() const override;
  std::string_view title() const override;
  pipeline::ScanPlan suggested_plan() const override { return {}; }
  void fill(Column& column, double phase, float x_mm, float y_mm) const override;
  float picture_width_mm() const override { return 6; }
  Look look(float x_mm, float y_mm) const override;
  std::vector<VesselSegment> vessels() const override { return {}; }
  const Instrument* instrument() const override { return nullptr; }

private:
  bool reflects(float x_mm, float y_mm) const;

  BenchSubject subject_;
};

} // namespace octascope::sim
