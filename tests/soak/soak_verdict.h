// What is wrong with a soaked run, from its samples and its report. Pure.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "tests/soak/process_sample.h"

namespace octascope::tests {

// The times at which nothing is wrong with any device: what a run holds is compared between them.
struct SoakTimes {
  double settled_from_s, settled_until_s; // after the warm-up
  double final_from_s;                    // until the end
};

struct Held {
  double resident_kib = 0;                  // median
  std::size_t descriptors = 0, threads = 0; // most
  std::size_t samples = 0;
};

// Of the samples in [from, until).
Held held_between(const std::vector<ProcessSample>& samples, double from_s, double until_s);

inline constexpr double most_growth = 0.01; // of the resident memory

// One line a complaint; empty: nothing grew.
std::vector<std::string> complaints_about_growth(const Held& settled, const Held& final);

// `most_lost`: volumes that the run's faults explain.
std::vector<std::string> complaints_about_volumes(const nlohmann::json& report, double most_lost);

} // namespace octascope::tests
