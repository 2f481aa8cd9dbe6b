#include "tests/support/devices/random_faults.h"

#include <algorithm>
#include <random>

#include <fmt/format.h>

namespace octascope::tests {

namespace {

using pipeline::Device;
using pipeline::Fault;

class FaultDice {
public:
  explicit FaultDice(unsigned seed) : random_(seed) {}

  double between(double low, double high) {
    return std::uniform_real_distribution<double>{low, high}(random_);
  }
  int any(int low, int high) { return std::uniform_int_distribution<int>{low, high}(random_); }

  const sim::ScriptableFault& any_kind() {
    const auto all = sim::scriptable_faults();
    return all[static_cast<std::size_t>(any(0, static_cast<int>(all.size()) - 1))];
  }

  // What belongs to the kind and to no other.
  std::string parameters(Fault kind) {
    switch (kind) {
    case Fault::late_frame: return chosen() + fmt::format("late_ms = {:.1f}\n", between(1, 300));
    case Fault::wrong_size:
      // Never 1, the right size, which a script may not name.
      return chosen() + fmt::format("size_share = {:.3f}\n", between(0, 0.99) + 1.01 * any(0, 1));
    case Fault::saturation: return chosen() + fmt::format("line_share = {:.3f}\n", between(0, 1));
    case Fault::dropped_frames:
    case Fault::corrupted_frame:
    case Fault::stuck_sequence:
    case Fault::missed_pulse: return chosen();
    case Fault::bounce:
      return fmt::format("bounces = {}\nbounce_ms = {:.1f}\n", any(1, 20), between(0.5, 4));
    case Fault::stuck_switch:
      return fmt::format("switch = {}\npressed = {}\n", any(0, 2), any(0, 1) == 1);
    default: return {};
    }
  }

private:
  // Few enough that a volume keeps some of its B-scans.
  std::string chosen() {
    return fmt::format("every = {}\nprobability = {:.3f}\nseed = {}\n", any(1, 5),
                       between(0.02, 0.6), any(0, 1000000));
  }

  std::mt19937 random_;
};

std::string one_fault(FaultDice& dice, const sim::ScriptableFault& fault, double at_s,
                      double duration_s) {
  return fmt::format(
      "[[fault]]\ndevice = \"{}\"\nkind = \"{}\"\nat_s = {:.3f}\nduration_s = {:.3f}\n{}\n",
      facts_of(fault.fault).device_key(), fault.kind, at_s, duration_s,
      dice.parameters(fault.fault));
}

} // namespace

std::string random_faults(unsigned seed, double from_s, double until_s, double mean_gap_s) {
  FaultDice dice{seed};
  std::string script;
  double at_s = from_s;
  while (true) {
    const sim::ScriptableFault& fault = dice.any_kind();
    const double duration_s = dice.between(0.05, 2);
    if (at_s + duration_s > until_s)
      return script;
    script += one_fault(dice, fault, at_s, duration_s);
    at_s += dice.between(0.1, 1.9) * mean_gap_s;
  }
}

Rehearsal every_fault_once(unsigned seed, double from_s) {
  constexpr double lasts_s = 0.5;
  constexpr double apart_s = 1.2;
  FaultDice dice{seed};
  Rehearsal rehearsal{{}, from_s};
  for (const sim::ScriptableFault& fault : sim::scriptable_faults()) {
    const bool again = fault.fault == sim::gone(Device::display);
    for (int i = 0; i < (again ? rehearsed_display_losses : 1); ++i) {
      rehearsal.script += one_fault(dice, fault, rehearsal.until_s, lasts_s);
      rehearsal.until_s += apart_s;
    }
  }
  return rehearsal;
}

double most_volumes_lost(const sim::FaultScript& script, hal::Duration tick_period) {
  constexpr double latest_retry_s = 2.5; // and the opening itself
  double volumes = 0;
  for (const sim::ScriptedFault& fault : script.faults) {
    const bool unplugged = fault.kind == sim::gone(Device::line_camera) ||
                           fault.kind == sim::gone(Device::galvo_trigger);
    if (!unplugged && fault.kind != Fault::missed_pulse && fault.kind != Fault::late_frame)
      continue;
    // Nothing is late but late frames.
    const double after_s = unplugged ? latest_retry_s : hal::to_seconds(fault.late_by);
    // The volumes at its beginning and at its end are cut.
    volumes += (hal::to_seconds(fault.duration) + after_s) / hal::to_seconds(tick_period) + 2;
  }
  return volumes;
}

} // namespace octascope::tests
