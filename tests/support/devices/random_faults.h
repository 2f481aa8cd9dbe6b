// Fault scripts as nobody would write them: any fault of any device, at any time, again from its
// seed.
#pragma once

#include <string>

#include "hal/clock.h"
#include "sim/faults/fault_script.h"

namespace octascope::tests {

// Text of a script (sim/faults/fault_script.h) whose faults all lie between the two times; one
// begins about every `mean_gap_s`, and they may overlap.
std::string random_faults(unsigned seed, double from_s, double until_s, double mean_gap_s);

// Each kind of fault of each device once, one after the other from `from_s` on, and the display's
// several times more: each of its losses ends a GL context and the threads that help drawing, and
// what the allocator keeps of them grows with the first few and then no more. `until_s` is when the
// last is over.
inline constexpr int rehearsed_display_losses = 8;
struct Rehearsal {
  std::string script;
  double until_s;
};
Rehearsal every_fault_once(unsigned seed, double from_s);

// How many volumes these faults can cost at the most: whole sweeps are lost while camera or trigger
// is away and until it was tried again (2 s at the latest), while pulses are missed, and while
// frames come later than their volume.
double most_volumes_lost(const sim::FaultScript& script, hal::Duration tick_period);

} // namespace octascope::tests
