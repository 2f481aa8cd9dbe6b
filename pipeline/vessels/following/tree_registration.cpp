#include "pipeline/vessels/following/tree_registration.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <numbers>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "pipeline/vessels/following/pose_fit.h"
#include "pipeline/vessels/following/sample_grid.h"
#include "pipeline/vessels/following/tree_samples.h"
#include "pipeline/vessels/vectors.h"

namespace octascope::pipeline {

namespace {

constexpr double step_mm = 0.04;
constexpr double score_mm = 0.08; // of the weights that places are compared by
constexpr double percent = 100;

struct Place {
  RigidTransform planned_from_live;
  double score = 0;
};

std::vector<TreeSample> spread(std::span<const TreeSample> samples, std::size_t most) {
  std::vector<TreeSample> few;
  const std::size_t count = std::min(samples.size(), most);
  for (std::size_t i = 0; i < count; ++i)
    few.push_back(samples[i * samples.size() / count]);
  return few;
}

double length_of(std::span<const TreeSample> samples) {
  double whole = 0;
  for (const TreeSample& sample : samples)
    whole += sample.length_mm;
  return whole;
}

// The direction that most of their length has, either way: where they are parallel, they may lie
// anywhere along it. By powers of the sum of their directions' squares.
Point main_direction(std::span<const TreeSample> samples) {
  constexpr int powers = 30;
  Point found = samples.front().along;
  for (int i = 0; i < powers; ++i) {
    Point next{};
    for (const TreeSample& sample : samples)
      next = sum(next, scaled(sample.along, sample.length_mm * product(sample.along, found)));
    found = direction(next);
  }
  return found;
}

// As one would see them: a turn by 6 degrees, or a shift by 0.2 mm.
constexpr double least_shift_mm = 0.2;
bool are_distinct(const RigidTransform& a, const RigidTransform& b, const Point& middle) {
  constexpr double least_turn_deg = 6;
  const RigidTransform change = a * inverse(b);
  const double trace = change.rotation[0][0] + change.rotation[1][1] + change.rotation[2][2];
  return (trace - 1) / 2 < std::cos(least_turn_deg * std::numbers::pi / 180) ||
         length(difference(a.apply(middle), b.apply(middle))) > least_shift_mm;
}

// Both trees, in the live one's frame but for what is to be found.
class TreePair {
public:
  TreePair(const VesselTree& planned, const VesselTree& live, const RigidTransform& start,
           const PoseReach& reach)
      : live_box_{box_around(live)}, middle_{live_box_.middle()}, start_{start},
        planned_box_{box_around(planned).grown(same_vessel_mm)}, live_{sample_tree(live, step_mm,
                                                                                   {}, live_box_)} {
    const double half_diagonal = length(difference(live_box_.upper, live_box_.lower)) / 2;
    constexpr double margin_mm = 0.3;
    const PointBox reached =
        live_box_.grown(half_diagonal * std::sin(reach.turn_deg * std::numbers::pi / 180) +
                        reach.shift_mm + margin_mm);
    planned_ = sample_tree(planned, step_mm, start, reached);
    grid_.emplace(planned_, step_mm, reached);
  }

  double live_mm() const { return length_of(live_); }
  double planned_mm() const { return length_of(planned_); }

  // The best one, and after it the best of those that are distinct from it, if any.
  std::vector<Place> find(const PoseReach& reach) const {
    constexpr std::size_t few = 100;
    constexpr std::size_t more = 300;
    constexpr std::size_t promising = 24;
    constexpr std::size_t last = 6;
    std::vector<Place> places;
    for (const RigidTransform& pose : search_poses(planned_, live_, middle_, reach))
      places.push_back({pose, 0});
    improve(places, spread(live_, few), {{0.2, 4}, {0.14, 3}}, 0.14);
    keep_distinct(places, promising);
    improve(places, spread(live_, more), {{0.12, 5}, {0.08, 5}}, score_mm);
    keep_distinct(places, last);
    improve(places, live_, {{0.08, 6}, {0.06, 10}}, score_mm);
    keep_distinct(places, 2);
    if (!places.empty())
      add_slid(places);
    keep_distinct(places, 2);
    return places;
  }

  TreeRegistration compare(const Place& place) const {
    TreeRegistration made;
    made.live_from_planned = inverse(place.planned_from_live) * start_;
    const RigidTransform to_planned = inverse(made.live_from_planned);
    double common = 0, same = 0, squares = 0;
    for (const TreeSample& sample : live_) {
      if (!planned_box_.contains(to_planned.apply(sample.at)))
        continue;
      common += sample.length_mm;
      const TreeSample there = moved(sample, place.planned_from_live);
      if (const auto beside = grid_->nearest(there.at, there.along, same_vessel_mm)) {
        same += sample.length_mm;
        squares += sample.length_mm * beside->distance_mm * beside->distance_mm;
      }
    }
    made.overlap = common > 0 ? same / common : 0;
    made.residual_mm = same > 0 ? std::sqrt(squares / same) : 0;
    made.planned_overlap = planned_overlap(inverse(place.planned_from_live));
    if (common < least_common_mm)
      made.refusal = fmt::format("the tree reaches {:.1f} mm of the {:.1f} mm of vessels that are "
                                 "seen, expected at least {:.0f} mm",
                                 common, live_mm(), least_common_mm);
    else if (made.overlap < least_tree_overlap)
      made.refusal = fmt::format("it has {:.0f} % of the vessels that are seen, expected at least "
                                 "{:.0f} %: they are others, or farther away",
                                 made.overlap * percent, least_tree_overlap * percent);
    return made;
  }

private:
  void improve(std::vector<Place>& places, std::span<const TreeSample> samples,
               std::initializer_list<FitStage> stages, double reach_mm) const {
    for (Place& place : places) {
      for (const FitStage& stage : stages)
        place.planned_from_live =
            fit_pose(*grid_, samples, middle_, place.planned_from_live, stage);
      place.score = pose_score(*grid_, samples, place.planned_from_live, reach_mm);
    }
  }

  // The first place, moved along the vessels just far enough to be another one. The search may have
  // come upon one that is farther along and fits less.
  void add_slid(std::vector<Place>& places) const {
    const Place best = places.front();
    constexpr double distinct_mm = 1.01 * least_shift_mm;
    const Point along = scaled(main_direction(live_), distinct_mm);
    for (const Point& shift : {along, scaled(along, -1)}) {
      RigidTransform slid;
      slid.shift_mm = shift;
      const RigidTransform pose = best.planned_from_live * slid;
      places.push_back({pose, pose_score(*grid_, live_, pose, score_mm)});
    }
  }

  // The best `most`, none like a better one.
  void keep_distinct(std::vector<Place>& places, std::size_t most) const {
    std::ranges::stable_sort(places, std::ranges::greater{}, &Place::score);
    std::vector<Place> kept;
    for (const Place& place : places)
      if (kept.size() < most && std::ranges::all_of(kept, [&](const Place& better) {
            return are_distinct(place.planned_from_live, better.planned_from_live, middle_);
          }))
        kept.push_back(place);
    places = std::move(kept);
  }

  double planned_overlap(const RigidTransform& live_from_started) const {
    const SampleGrid live_grid{live_, step_mm, live_box_};
    double seen = 0, same = 0;
    for (const TreeSample& sample : planned_) {
      const TreeSample there = moved(sample, live_from_started);
      if (!live_box_.contains(there.at))
        continue;
      seen += sample.length_mm;
      if (live_grid.nearest(there.at, there.along, same_vessel_mm))
        same += sample.length_mm;
    }
    return seen > 0 ? same / seen : 0;
  }

  PointBox live_box_;
  Point middle_;
  RigidTransform start_;
  PointBox planned_box_; // in its own frame
  std::vector<TreeSample> live_, planned_;
  std::optional<SampleGrid> grid_; // of the planned tree
};

TreeRegistration refused(std::string why) {
  TreeRegistration none;
  none.lead = 0;
  none.refusal = std::move(why);
  return none;
}

} // namespace

PoseReach first_reach(double longest_side_mm) {
  return {.turn_deg = 20, .shift_mm = longest_side_mm / 3};
}

TreeRegistration register_trees(const VesselTree& planned, const VesselTree& live,
                                const RigidTransform& start, const PoseReach& reach) {
  if (planned.nodes() == 0 || live.nodes() == 0)
    return refused(fmt::format("there is no {} tree", live.nodes() == 0 ? "live" : "planned"));
  const TreePair trees{planned, live, start, reach};
  if (trees.live_mm() < least_common_mm)
    return refused(fmt::format("{:.1f} mm of vessels are seen, expected at least {:.0f} mm",
                               trees.live_mm(), least_common_mm));
  if (trees.planned_mm() < least_common_mm)
    return refused(fmt::format("the tree has {:.1f} mm of vessels within reach, expected at least "
                               "{:.0f} mm",
                               trees.planned_mm(), least_common_mm));
  const std::vector<Place> places = trees.find(reach);
  if (places.empty()) // they only cross, or fit ever better up to the reach's end
    return refused("no place within reach fits: they are others, or farther away");
  TreeRegistration made = trees.compare(places.front());
  if (places.size() > 1)
    made.lead = places[0].score - places[1].score;
  if (made.refusal.empty() && made.lead < least_pose_lead)
    made.refusal = fmt::format("another place fits nearly as well: {:.2f} apart, expected at "
                               "least {:.2f}",
                               made.lead, least_pose_lead);
  return made;
}

} // namespace octascope::pipeline
