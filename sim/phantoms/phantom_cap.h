// A plastic cap: a domed shell with grip ribs outside, a cross of walls inside, and in its wall a
// thin network of channels with a flowing, scattering fluid.
#pragma once

#include "sim/phantoms/phantom.h"
#include "sim/phantoms/phantom_vessels.h"

namespace octascope::sim {

class PlasticCap final : public Phantom {
public:
  explicit PlasticCap(std::uint64_t seed);

  std::string_view name() const override { return "cap"; }
  std::string_view title() const override { return "plastic cap"; }
  pipeline::ScanPlan suggested_plan() const override { return {}; }
  void fill(Column& column, double phase, float x_mm, float y_mm) const override;
  float picture_width_mm() const override { return 6; }
  Look look(float x_mm, float y_mm) const override;
  std::vector<VesselSegment> vessels() const override;
  const Instrument* instrument() const override { return nullptr; }

  static constexpr float wall_mm = 0.36F;
  static constexpr float inner_rib_mm = 0.075F; // half width of the cross's walls
  static float outer_mm(float x_mm, float y_mm);
  static float inner_mm(float x_mm, float y_mm);

private:
  std::uint64_t seed_;
  VesselBed channels_; // depths below the outer surface
};

} // namespace octascope::sim
