// Registrations of vessel trees whose true place is known, and of wrong trees.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "hal/result.h"

namespace octascope::firmware_host {

// As far as a known motion must be recovered: turns about the middle of the field.
inline constexpr double most_turn_deg = 20;
inline constexpr double most_shift_of_field = 1.0 / 3;
// And how well.
inline constexpr double right_within_mm = 0.05;
inline constexpr double right_within_deg = 1;

// One kind of trial, all of them together.
struct TrialFigures {
  std::string kind;
  bool same = true; // it must be found; else it must be refused
  int trials = 0;
  int right = 0;         // found within the limits; or refused
  int misplaced = 0;     // accepted at a wrong place, or as another tree
  double least_lead = 1; // of all that were accepted
  double least_overlap = 1, most_overlap = 0;
  double largest_off_mm = 0; // at the middle of the field, and of the turn; of what is right
  double largest_turn_deg = 0;
  double longest_s = 0; // processor time of one registration
};

struct TrialOptions {
  int trials = 100;   // of the same and of wrong trees, each: shared out among their kinds
  bool traced = true; // also in a tree traced in simulated flow: that alone takes some 10 s
  std::uint64_t seed = 1;
};

// One after the other on this thread. `progress`: words for what is done at the moment.
hal::Result<std::vector<TrialFigures>>
registration_trials(const TrialOptions& options,
                    const std::function<void(const std::string&)>& progress);

} // namespace octascope::firmware_host
