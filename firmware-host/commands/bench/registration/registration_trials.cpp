#include "firmware-host/commands/bench/registration/registration_trials.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <ctime>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "firmware-host/commands/bench/flow/bench_flow.h"
#include "firmware-host/commands/bench/registration/imperfect_tree.h"
#include "pipeline/vessels/following/tree_registration.h"
#include "pipeline/vessels/vectors.h"
#include "sim/coronary_tree/coronary_tree.h"
#include "sim/phantoms/phantom.h"
#include "sim/phantoms/phantom_tree.h"

namespace octascope::firmware_host {

namespace {

using pipeline::Point;
using pipeline::PointBox;
using pipeline::RigidTransform;
using pipeline::VesselTree;

// Of the perfused phantom's volume; all trials are in a field of this size.
constexpr PointBox field{{0, 0, 0}, {3, 3, 1.8}};
constexpr Point middle{1.5, 1.5, 0.6}; // of the tissue
constexpr double side_mm = 3;
constexpr double everywhere_mm = 1000;
constexpr PointBox everywhere{{-everywhere_mm, -everywhere_mm, -everywhere_mm},
                              {everywhere_mm, everywhere_mm, everywhere_mm}};
constexpr TraceFlaws no_flaws{.least_radius_mm = 0, .off_mm = 0, .missing = 0, .invented = 0};

double processor_s() {
  std::timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double turn_deg(const RigidTransform& of) {
  const double trace = of.rotation[0][0] + of.rotation[1][1] + of.rotation[2][2];
  return std::acos(std::clamp((trace - 1) / 2, -1.0, 1.0)) * 180 / std::numbers::pi;
}

class Trials {
public:
  explicit Trials(std::uint64_t seed) : random_{seed} {}

  // Up to the limits, evenly by size, in any direction.
  RigidTransform motion() {
    const double turn = random_.unit() * most_turn_deg * std::numbers::pi / 180;
    const double shift = random_.unit() * most_shift_of_field * side_mm;
    return pipeline::turned_about(middle, pipeline::scaled(any_direction(), turn),
                                  pipeline::scaled(any_direction(), shift));
  }

  VesselTree traced(const VesselTree& tree) { return imperfect_tree(tree, field, {}, random_); }

  void find(TrialFigures& figures, const VesselTree& planned, const VesselTree& live,
            const RigidTransform& truth) {
    const auto made = registered(figures, planned, live);
    if (!made.refusal.empty())
      return;
    const RigidTransform error = made.live_from_planned * pipeline::inverse(truth);
    const double off_mm = pipeline::length(pipeline::difference(error.apply(middle), middle));
    const double off_deg = turn_deg(error);
    figures.least_lead = std::min(figures.least_lead, made.lead);
    if (off_mm > right_within_mm || off_deg > right_within_deg) {
      ++figures.misplaced;
      return;
    }
    ++figures.right;
    figures.largest_off_mm = std::max(figures.largest_off_mm, off_mm);
    figures.largest_turn_deg = std::max(figures.largest_turn_deg, off_deg);
  }

  void refuse(TrialFigures& figures, const VesselTree& planned, const VesselTree& live) {
    const bool accepted = registered(figures, planned, live).refusal.empty();
    ++(accepted ? figures.misplaced : figures.right);
  }

  sim::HashRandom& random() { return random_; }

private:
  Point any_direction() {
    for (;;) {
      const Point at{random_.both_ways(), random_.both_ways(), random_.both_ways()};
      if (const double from_middle = pipeline::length(at); from_middle > 0.1 && from_middle < 1)
        return pipeline::direction(at);
    }
  }

  static pipeline::TreeRegistration registered(TrialFigures& figures, const VesselTree& planned,
                                               const VesselTree& live) {
    const double begun = processor_s();
    auto made = pipeline::register_trees(planned, live, {}, pipeline::first_reach(side_mm));
    figures.longest_s = std::max(figures.longest_s, processor_s() - begun);
    ++figures.trials;
    figures.least_overlap = std::min(figures.least_overlap, made.overlap);
    figures.most_overlap = std::max(figures.most_overlap, made.overlap);
    return made;
  }

  sim::HashRandom random_;
};

hal::Result<VesselTree> perfused(std::uint64_t seed) {
  HAL_TRY(const auto phantom, sim::make_phantom("perfused", seed));
  const sim::PhantomTree tree = sim::phantom_tree(*phantom);
  return moved_tree(tree.tree, tree.volume_from_tree);
}

VesselTree mirrored(VesselTree tree, std::size_t axis) {
  for (auto& at : tree.positions_mm)
    at[axis] = static_cast<float>(2 * middle[axis]) - at[axis];
  return tree;
}

// What surrounds places of a heart where vessels are wide, with the place in the field's middle.
class HeartPlaces {
public:
  static hal::Result<HeartPlaces> make() {
    HAL_TRY(auto made, sim::generate_coronary_tree({.segments = 1'000'000, .seed = 1}));
    return HeartPlaces{std::move(made.tree)};
  }

  // 7 mm wide: more than the field and all that may move into it.
  VesselTree any(sim::HashRandom& random) const {
    constexpr float wide_mm = 0.06F;
    constexpr double enough_mm = 10; // of vessels in the field
    constexpr PointBox around{{-2, -2, -2}, {5, 5, 4}};
    for (;;) {
      const std::size_t node = random.below(heart_.nodes());
      if (heart_.radii_mm[node] < wide_mm)
        continue;
      RigidTransform to_field;
      for (std::size_t axis = 0; axis < 3; ++axis)
        to_field.shift_mm[axis] = middle[axis] - double{heart_.positions_mm[node][axis]};
      VesselTree tree = imperfect_tree(moved_tree(heart_, to_field), around, no_flaws, random);
      const VesselTree seen =
          imperfect_tree(tree, field, {.off_mm = 0, .missing = 0, .invented = 0}, random);
      double length_mm = 0;
      if (seen.nodes() > 0)
        for (const auto& sample : pipeline::sample_tree(seen, 0.04, {}, field))
          length_mm += sample.length_mm;
      if (length_mm >= enough_mm)
        return tree;
    }
  }

private:
  explicit HeartPlaces(VesselTree heart) : heart_{std::move(heart)} {}
  VesselTree heart_;
};

} // namespace

hal::Result<std::vector<TrialFigures>>
registration_trials(const TrialOptions& options,
                    const std::function<void(const std::string&)>& progress) {
  constexpr std::uint64_t seeds = 12;
  std::vector<VesselTree> beds;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    HAL_TRY(auto bed, perfused(seed));
    beds.push_back(std::move(bed));
  }
  progress("growing a heart's arteries");
  HAL_TRY(const auto heart, HeartPlaces::make());
  VesselTree traced;
  if (options.traced) {
    progress("simulating a volume with flow");
    HAL_TRY(auto of_bench, trace_bench_scene(2));
    traced = std::move(of_bench.tree);
  }

  Trials trials{options.seed};
  TrialFigures earlier{.kind = "earlier self"}, whole{.kind = "all of the bed"},
      larger{.kind = "larger, of a heart"}, in_flow{.kind = "all of the bed, in flow"},
      other{.kind = "another bed", .same = false}, mirror{.kind = "mirrored", .same = false},
      elsewhere{.kind = "another place", .same = false},
      other_in_flow{.kind = "another bed, in flow", .same = false};
  const int kinds = options.traced ? 4 : 3;
  for (int i = 0; i < options.trials; ++i) {
    progress(fmt::format("trial {} of {}", i + 1, options.trials));
    const auto turn = static_cast<std::size_t>(i / kinds);
    const VesselTree& bed = beds[turn % beds.size()];
    const VesselTree& another = beds[(turn + 1 + turn / beds.size() % (seeds - 1)) % beds.size()];
    const RigidTransform motion = trials.motion();
    switch (i % kinds) {
    case 0: {
      const VesselTree live = trials.traced(moved_tree(bed, motion));
      trials.find(earlier, trials.traced(bed), live, motion);
      trials.refuse(other, another, live);
      break;
    }
    case 1: {
      trials.find(whole, bed, trials.traced(moved_tree(bed, motion)), motion);
      trials.refuse(mirror, bed, trials.traced(moved_tree(mirrored(bed, turn % 3), motion)));
      break;
    }
    case 2: {
      const VesselTree place = heart.any(trials.random());
      const VesselTree live = trials.traced(moved_tree(place, motion));
      trials.find(larger, place, live, motion);
      trials.refuse(elsewhere, heart.any(trials.random()), live);
      break;
    }
    default: // the live tree stands still, and the other one has moved
      trials.find(in_flow, moved_tree(beds.front(), pipeline::inverse(motion)), traced, motion);
      trials.refuse(other_in_flow,
                    moved_tree(beds[1 + turn % (seeds - 1)], pipeline::inverse(motion)), traced);
      break;
    }
  }
  std::vector<TrialFigures> all{earlier, whole,  larger,    in_flow,
                                other,   mirror, elsewhere, other_in_flow};
  std::erase_if(all, [](const TrialFigures& figures) { return figures.trials == 0; });
  return all;
}

} // namespace octascope::firmware_host
