// Perfused tissue: a block under an uneven surface, with a bed of vessels that branch down to the
// resolution limit.
#pragma once

#include "sim/phantoms/phantom.h"
#include "sim/phantoms/phantom_vessels.h"

namespace octascope::sim {

// Six vessels enter the field and fork, three of them until their branches are capillaries: from 8
// A-scans wide to less than one. The tissue's signal is about 25 dB above the noise at its surface and falls with
// depth.
class PerfusedTissue final : public Phantom {
public:
  explicit PerfusedTissue(std::uint64_t seed);

  std::string_view name() const override { return "perfused"; }
  std::string_view title() const override { return "perfused tissue"; }
  pipeline::ScanPlan suggested_plan() const override { return {}; }
  void fill(Column& column, double phase, float x_mm, float y_mm) const override;
  float picture_width_mm() const override { return 6; }
  Look look(float x_mm, float y_mm) const override;
  std::vector<VesselSegment> vessels() const override;
  const Instrument* instrument() const override { return nullptr; }

  static constexpr float widest_mm = 0.04F;      // radii
  static constexpr float capillary_mm = 0.0045F; // the thinnest
  float top_mm(float x_mm, float y_mm) const;

private:
  std::uint64_t seed_;
  VesselBed bed_; // depths below the surface
};

} // namespace octascope::sim
