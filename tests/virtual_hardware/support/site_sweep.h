// System calls that are made to fail, site by site, in processes that may die.
//
// For scenarios of which a library under ours may die (it asserts, or takes what it did not get),
// and for those with too many calls to hit each: a site that is called in a loop is hit once.
// Faults follow one another in a process until one does not end well: the next has a new process.
// So each that does well has shown, too, that the one before it left nothing amiss.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tests/virtual_hardware/support/syscall_faults.h"

namespace octascope::tests {

// Where a library is known to die or to hang: parts of the site's name and of the stack then, and
// what the library does there.
struct KnownDeath {
  std::string_view site, stack, reason;
};

struct SweepPlan {
  unsigned kinds = every_kind;
  // Says what is wrong with how it ended, as for inject_faults().
  std::function<std::optional<std::string>()> scenario;
  // Before the first scenario in a process, and unharmed: false if it failed. `end` gives back what
  // it took, threads above all.
  std::function<bool()> begin = {};
  std::function<void()> end = {};
  // After a fault that left something behind, or that was missed, unharmed, in the same process,
  // and in the test's own after all: says what is wrong.
  std::function<std::optional<std::string>()> afterwards = {};
  // Where one of these came true, the site is spared the other errors.
  std::span<const KnownDeath> known = {};
};

struct SweepReport {
  unsigned calls = 0, sites = 0; // of the scenario unharmed
  unsigned faults = 0, processes = 0;
  unsigned spared = 0;            // faults
  unsigned missed = 0;            // faults whose site was not come by: another thread was faster
  unsigned left_behind = 0;       // faults after which descriptors or mappings were left
  std::vector<std::string> known; // deaths, in words
  std::vector<std::string> complaints; // everything else that is wrong
};

// The errors that Linux may give for a call of that kind: EINTR, EAGAIN, ENODEV, ENOMEM, EIO; 0 is
// half a read or write.
std::span<const int> possible_errors(CallKind kind);

// The process must have one thread only: when this is called, after `end`, or after each scenario
// where there is none.
SweepReport sweep_sites(const SweepPlan& plan);

// Prints the figures and the known deaths.
void print(const SweepReport& report);

} // namespace octascope::tests
