// Phantoms: scenes in millimetres, observed by the simulated spectrometer and the simulated
// microscope camera.
//
// Axes: x along the fast axis a, y along the slow axis b, both from the centre of the scan field; z
// is depth below the first depth bin. Time is a phase: 0 … 1 is one loop of the scene, and phases
// that differ by a whole number are the same moment.
#pragma once

#include <array>
#include <memory>
#include <string_view>
#include <vector>

#include "hal/result.h"
#include "pipeline/scan/scan_plan.h"
#include "sim/phantoms/phantom_column.h"
#include "sim/phantoms/phantom_vessels.h"

namespace octascope::sim {

struct Rgb {
  float r = 0; // 0 … 1, before illumination
  float g = 0;
  float b = 0;
};

constexpr Rgb mix(const Rgb& a, const Rgb& b, float t) {
  return {a.r + (b.r - a.r) * t, a.g + (b.g - a.g) * t, a.b + (b.b - a.b) * t};
}

// The appearance of a place from above.
struct Look {
  Rgb colour;
  float height_mm = 0; // towards the microscope, for the shading; its zero is arbitrary
  float gloss = 0;     // 0 … 1: strength of the lamp's mirror image
};

class Instrument;

// Immutable, so thread-safe. Allocates only at construction.
class Phantom {
public:
  virtual ~Phantom() = default;

  virtual std::string_view name() const = 0;  // as for make_phantom()
  virtual std::string_view title() const = 0; // for display

  // The plan with the most suitable spacings.
  virtual pipeline::ScanPlan suggested_plan() const = 0;

  // Replaces the contents of `column`.
  virtual void fill(Column& column, double phase, float x_mm, float y_mm) const = 0;

  // For the microscope's picture: its width on the tissue, and the look of a place without the
  // instrument.
  virtual float picture_width_mm() const = 0;
  virtual Look look(float x_mm, float y_mm) const = 0;

  // Its vessels, each after the one that it leaves; depths below the first depth bin.
  virtual std::vector<VesselSegment> vessels() const = 0;

  // The moving instrument, or null. Valid for the phantom's lifetime.
  virtual const Instrument* instrument() const = 0;
};

inline constexpr std::array<std::string_view, 4> phantom_names = {"anterior_eye", "nail_fold",
                                                                  "cap", "perfused"};
// What is looked at while an instrument is set up (phantom_bench.h).
inline constexpr std::array<std::string_view, 4> bench_phantom_names = {"dark", "mirror_near",
                                                                        "mirror_far", "target"};

// ErrorCode::invalid_argument: no such phantom. The same seed gives the same phantom.
hal::Result<std::unique_ptr<Phantom>> make_phantom(std::string_view name, std::uint64_t seed);

} // namespace octascope::sim
