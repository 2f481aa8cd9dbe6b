#include "tests/support/devices/random_faults.h"

#include <algorithm>
#include <random>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace octascope::tests {

namespace {

using sim::FaultKind;

class FaultDice {
public:
  explicit FaultDice(unsigned seed) : random_(seed) {}

  double between(double low, double high) {
    return std::uniform_real_distribution<double>{low, high}(random_);
  }
  int any(int low, int high) { return std::uniform_int_distribution<int>{low, high}(random_); }

  std::pair<sim::FaultDevice, FaultKind> any_kind() {
    std::vector<std::pair<sim::FaultDevice, FaultKind>> all;
    for (const sim::FaultDevice device : sim::fault_devices)
      for (const FaultKind kind : sim::kinds_of(device))
        all.emplace_back(device, kind);
    return all[static_cast<std::size_t>(any(0, static_cast<int>(all.size()) - 1))];
  }

  // What belongs to the kind and to no other.
  std::string parameters(FaultKind kind) {
    switch (kind) {
    case FaultKind::late_frames:
      return chosen() + fmt::format("late_ms = {:.1f}\n", between(1, 300));
    case FaultKind::wrong_size:
      return chosen() + fmt::format("size_share = {:.3f}\n", between(0, 0.99) + any(0, 1));
    case FaultKind::saturation:
      return chosen() + fmt::format("line_share = {:.3f}\n", between(0, 1));
    case FaultKind::dropped_frames:
    case FaultKind::corrupted_frames:
    case FaultKind::stuck_sequence:
    case FaultKind::missed_pulses: return chosen();
    case FaultKind::bounce:
      return fmt::format("bounces = {}\nbounce_ms = {:.1f}\n", any(1, 20), between(0.5, 4));
    case FaultKind::stuck_switch:
      return fmt::format("switch = {}\npressed = {}\n", any(0, 2), any(0, 1) == 1);
    case FaultKind::unplug:
    case FaultKind::lost: return {};
    }
    return {};
  }

private:
  // Few enough that a volume keeps some of its B-scans.
  std::string chosen() {
    return fmt::format("every = {}\nprobability = {:.3f}\nseed = {}\n", any(1, 5),
                       between(0.02, 0.6), any(0, 1000000));
  }

  std::mt19937 random_;
};

std::string one_fault(FaultDice& dice, sim::FaultDevice device, FaultKind kind, double at_s,
                      double duration_s) {
  return fmt::format(
      "[[fault]]\ndevice = \"{}\"\nkind = \"{}\"\nat_s = {:.3f}\nduration_s = {:.3f}\n{}\n",
      to_string(device), to_string(kind), at_s, duration_s, dice.parameters(kind));
}

} // namespace

std::string random_faults(unsigned seed, double from_s, double until_s, double mean_gap_s) {
  FaultDice dice{seed};
  std::string script;
  double at_s = from_s;
  while (true) {
    const auto [device, kind] = dice.any_kind();
    const double duration_s = dice.between(0.05, 2);
    if (at_s + duration_s > until_s)
      return script;
    script += one_fault(dice, device, kind, at_s, duration_s);
    at_s += dice.between(0.1, 1.9) * mean_gap_s;
  }
}

Rehearsal every_fault_once(unsigned seed, double from_s) {
  constexpr double lasts_s = 0.5;
  constexpr double apart_s = 1.2;
  FaultDice dice{seed};
  Rehearsal rehearsal{{}, from_s};
  for (const sim::FaultDevice device : sim::fault_devices) {
    for (const FaultKind kind : sim::kinds_of(device)) {
      const bool again = device == sim::FaultDevice::display;
      for (int i = 0; i < (again ? rehearsed_display_losses : 1); ++i) {
        rehearsal.script += one_fault(dice, device, kind, rehearsal.until_s, lasts_s);
        rehearsal.until_s += apart_s;
      }
    }
  }
  return rehearsal;
}

double most_volumes_lost(const sim::FaultScript& script, hal::Duration tick_period) {
  constexpr double latest_retry_s = 2.5; // and the opening itself
  double volumes = 0;
  for (const sim::ScriptedFault& fault : script.faults) {
    const bool of_the_scan = fault.device == sim::FaultDevice::line_camera ||
                             fault.device == sim::FaultDevice::galvo_trigger;
    const bool whole = fault.kind == FaultKind::unplug || fault.kind == FaultKind::missed_pulses ||
                       fault.kind == FaultKind::late_frames;
    if (!of_the_scan || !whole)
      continue;
    const double after_s = fault.kind == FaultKind::unplug        ? latest_retry_s
                           : fault.kind == FaultKind::late_frames ? hal::to_seconds(fault.late_by)
                                                                  : 0;
    // The volumes at its beginning and at its end are cut.
    volumes += (hal::to_seconds(fault.duration) + after_s) / hal::to_seconds(tick_period) + 2;
  }
  return volumes;
}

} // namespace octascope::tests
