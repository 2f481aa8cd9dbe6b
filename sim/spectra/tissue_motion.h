// Bulk motion of the tissue below the beam, from line to line: heartbeat, breathing, tremor.
//
// Unlike ScanMotion, which makes the scan meet other B-scans of a ring made beforehand, this motion
// is part of the spectra, to a fraction of a depth bin and with its phase.
#pragma once

#include <vector>

#include "hal/result.h"

namespace octascope::sim {

struct MotionTone {
  double amplitude_um = 0;
  double frequency_hz = 0;

  bool operator==(const MotionTone&) const = default;
};

// A displacement is the sum of its tones, amplitude · sin(2π · frequency · t + 2.4 · n), n = 0 for
// the first tone, 1 for the second …, so that they do not all begin together. A function of t alone,
// so the motion is the same in every run.
struct TissueMotion {
  std::vector<MotionTone> axial;   // downwards
  std::vector<MotionTone> lateral; // along the fast axis, towards higher A-scans

  // At most 8 tones each, of 0 to 200 µm and 0 to 10 000 Hz.
  hal::Result<> validate() const;

  double axial_um(double t_s) const;
  double lateral_um(double t_s) const;

  bool operator==(const TissueMotion&) const = default;
};

} // namespace octascope::sim
