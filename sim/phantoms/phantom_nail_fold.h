// Skin at a nail fold: the skin's layers, the nail that emerges from under it, the nail's root, and
// the capillary loops along the fold.
#pragma once

#include "sim/phantoms/phantom.h"
#include "sim/phantoms/phantom_vessels.h"

namespace octascope::sim {

// The finger lies along y: skin at y < fold_y, nail plate beyond. Sizes of an adult's finger.
class NailFold final : public Phantom {
public:
  explicit NailFold(std::uint64_t seed);

  std::string_view name() const override { return "nail_fold"; }
  std::string_view title() const override { return "skin at a nail fold"; }
  pipeline::ScanPlan suggested_plan() const override { return {}; }
  void fill(Column& column, double phase, float x_mm, float y_mm) const override;
  float picture_width_mm() const override { return 6; }
  Look look(float x_mm, float y_mm) const override;
  std::vector<VesselSegment> vessels() const override;
  const Instrument* instrument() const override { return nullptr; }

  static constexpr float root_y_mm = -1.15F; // beginning of the nail, under the skin
  static constexpr float plate_mm = 0.38F;   // full thickness
  static float nail_top_mm(float x_mm, float y_mm);
  static float nail_thickness_mm(float y_mm);
  float fold_y_mm(float x_mm) const; // edge of the skin
  float skin_top_mm(float x_mm, float y_mm) const;

private:
  void fill_skin(Column& column, float x_mm, float y_mm, float bottom_mm) const;
  void fill_nail(Column& column, float x_mm, float y_mm, bool open) const;

  std::uint64_t seed_;
  VesselBed skin_vessels_; // depths below the skin's top
  VesselBed bed_vessels_;  // depths below the nail plate
};

} // namespace octascope::sim
