// Joins the centrelines that other programs write into trees.
//
// The centrelines are polylines over points. Some programs (VMTK) write one from the mouth to each
// tip, or from each tip to the mouth, so that common vessels are in the file several times; others
// write one a vessel, which share points or end at the same place. Lines that begin at the same
// place are one vessel as long as they run together (centreline_run.h), however each is sampled;
// once apart they stay apart, even where they touch again. Otherwise two lines are joined only if
// an end of one lies within a tenth of the radius of the other. Lines that merely cross belong to
// two trees.
//
// Each connected piece becomes a tree. If all its lines end at one place but begin at several, its
// root is that end; else it is the beginning of the first line that begins where no other line
// leads.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "pipeline/vessels/tree.h"

namespace octascope::pipeline {

struct Centrelines {
  std::vector<std::array<double, 3>> positions_mm;
  std::vector<double> radii_mm;
  std::vector<std::uint64_t> points; // of all lines, one after the other; indices of positions
  std::vector<std::uint64_t> ends;   // of each line in `points`: one past its last
};

struct JoinedCentrelines {
  VesselTree tree;                 // without orders
  std::uint64_t merged_points = 0; // of vessels that an earlier line has
  std::uint64_t unused_points = 0; // in no line
  std::uint64_t short_lines = 0;   // of fewer than two points
  std::string loop; // where two ways lead to one point, so that there is no tree; else empty
};

// `ends` must never decrease and must end with points.size(); points must be indices of positions.
JoinedCentrelines join_centrelines(const Centrelines& lines);

} // namespace octascope::pipeline
