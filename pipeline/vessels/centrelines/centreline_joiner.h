// Centrelines, as other programs give them, joined into a tree.
//
// They come as polylines over points: one from the mouth to every tip or from every tip to the
// mouth, so that what two have in common is there twice (VMTK), or one a vessel, joined by a shared
// point or by ends at one place. Lines that begin at one place are one vessel for as long as they
// run together (centreline_run.h), however each is sampled; once they have parted they stay two,
// where they touch again, too. Else two lines are joined only by an end: one of either that lies
// within a tenth of the radius of the other. Lines that merely cross are two trees.
//
// Each connected piece is a tree. Its root is the end of all its lines if that is one place and
// their beginnings are not; else the beginning of its first line that begins where no other line
// leads to.
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
  std::vector<std::uint64_t> ends;   // of each line in `points`, one behind its last
};

struct JoinedCentrelines {
  VesselTree tree;                 // without orders
  std::uint64_t merged_points = 0; // of vessels that another line gave
  std::uint64_t unused_points = 0; // in no line
  std::uint64_t short_lines = 0;   // of fewer than two points
  std::string loop;                // not empty: where two ways lead to one point; there is no tree
};

// `ends` must not fall, and end with points.size(); points must be indices of positions.
JoinedCentrelines join_centrelines(const Centrelines& lines);

} // namespace octascope::pipeline
