// The front of an eye: cornea, anterior chamber, iris with its pupil, lens, the limbus with its
// vessels, and forceps that work in the chamber.
#pragma once

#include "sim/phantoms/phantom.h"
#include "sim/phantoms/phantom_instrument.h"
#include "sim/phantoms/phantom_vessels.h"

namespace octascope::sim {

// Sizes are textbook values of an adult human eye: radii of the cornea 7.8 and 6.9 mm, 0.54 mm
// thick at its apex, chamber 3 mm deep, limbus at 5.5 mm, pupil of 4 mm, lens front of 10 mm
// radius. The eye looks a little to the left, so that the limbus is in the field at the right,
// where the instrument enters.
class AnteriorEye final : public Phantom {
public:
  explicit AnteriorEye(std::uint64_t seed);

  std::string_view name() const override { return "anterior_eye"; }
  std::string_view title() const override { return "front of the eye"; }
  pipeline::ScanPlan suggested_plan() const override;
  void fill(Column& column, double phase, float x_mm, float y_mm) const override;
  float picture_width_mm() const override { return 15; }
  Look look(float x_mm, float y_mm) const override;
  std::vector<VesselSegment> vessels() const override;
  const Instrument* instrument() const override { return &forceps_; }

  // The geometry, in mm below the first depth bin; `r_mm` from the eye's axis.
  static constexpr float apex_mm = 0.5F;
  static constexpr float axis_x_mm = -1.2F;
  static constexpr float limbus_mm = 5.5F;
  static constexpr float pupil_mm = 2.0F; // radius
  static float cornea_front_mm(float r_mm);
  static float cornea_back_mm(float r_mm);
  static float lens_front_mm(float r_mm);
  static float iris_front_mm(float r_mm); // without its folds, pupil_mm ≤ r

private:
  void fill_cornea(Column& column, float r_mm) const;
  void fill_sclera(Column& column, float x_mm, float y_mm, float r_mm) const;
  void fill_iris(Column& column, float x_mm, float y_mm, float r_mm) const;
  float iris_top_mm(float x_mm, float y_mm, float r_mm) const; // with its folds
  float iris_fold(float x_mm, float y_mm, float r_mm) const;

  std::uint64_t seed_;
  Instrument forceps_;
  VesselBed iris_vessels_;   // depths below the iris' front
  VesselBed limbal_vessels_; // depths below the sclera's front
};

} // namespace octascope::sim
