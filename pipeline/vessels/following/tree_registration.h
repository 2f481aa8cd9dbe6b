// Where a vessel tree that is known lies in the one that is seen now.
//
// Steps and their sources: tree_samples.h, pose_search.h (every turn and shift, coarsely), pose_fit.h
// (iterated closest points), then a verdict by what both trees have in common.
//
// Allocates, and takes a good part of a second to search, some 10 ms from a pose nearby: not for
// threads that others wait for. Reentrant.
#pragma once

#include <string>

#include "pipeline/vessels/following/pose_search.h"
#include "pipeline/vessels/rigid_transform.h"
#include "pipeline/vessels/tree.h"

namespace octascope::pipeline {

// Below, a tree is not drawn at the place that was found. Of other vessels up to half is matched by
// chance, of the same ones nine tenths are (docs/ANGIOGRAPHY.md).
inline constexpr double least_tree_overlap = 0.65;
// A second place that fits nearly as well makes the first one a guess.
inline constexpr double least_pose_lead = 0.1;
// Of live vessels, and of those where the planned tree reaches: fewer may lie anywhere.
inline constexpr double least_common_mm = 6;
// Vessels are the same if they lie across from each other by no more, within 35 degrees.
inline constexpr double same_vessel_mm = 0.05;

struct TreeRegistration {
  RigidTransform live_from_planned; // without meaning if refused
  double residual_mm = 0;           // root mean square across vessels, of those that are the same
  double overlap = 0; // of the live tree where the planned one reaches, the share that it has too
  double planned_overlap =
      0;               // and the other way, in the live tree's box: low where that lacks twigs
  double lead = 1;     // of mean weights, over the next best other place that was looked at
  std::string refusal; // empty: it may be used; else why not, a sentence without its full stop
};

// A third of the field, and 20 degrees: as far as a first search has to look.
PoseReach first_reach(double longest_side_mm);
// From one registration to the next.
inline constexpr PoseReach next_reach{.turn_deg = 5, .shift_mm = 0.15};

// `start` puts the planned tree near its place; it turns about the middle of the live tree's box, and
// may be off by no more than `reach`.
TreeRegistration register_trees(const VesselTree& planned, const VesselTree& live,
                                const RigidTransform& start, const PoseReach& reach);

} // namespace octascope::pipeline
