// What flows, seen from above. Pure.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pipeline/threads/work_team.h"
#include "pipeline/volume/volume.h"
#include "ui/panels/tissue_map.h"

namespace octascope::ui {

// Of an A-scan. The depth is multiplied by the strength, so that what is interpolated between two
// A-scans has the depth of the one that flows.
struct FlowFromAbove {
  // A count of flow_scale.h: the highest mean of `flow_run` depths; 0 where that is not seen
  // (ui/transfer/flow_look.h).
  std::uint8_t strength = 0;
  std::uint8_t strength_by_depth =
      0; // times their depth below the surface, as a share of the volume's

  bool operator==(const FlowFromAbove&) const = default;
};

// As deep as the kernel that flow is found with: less is an error's.
inline constexpr int flow_run = 5;

// Of a volume that is still coming: the strongest run of depths of each A-scan, wherever it lies. Nearly all
// lie in tissue, of which only the whole volume tells where it begins.
//
// Threads: one at a time. Allocates only when the geometry changes.
class ComingRuns {
public:
  // Takes what is new in that volume, whose first `finished` B-scans are there with their flow.
  // `number`: the metadata's index that it will have.
  void bring(const pipeline::Volume& coming, std::uint64_t number, int finished);

  struct Run {
    std::uint16_t from = 0; // the first of its depths
    std::uint16_t sum = 0;  // 0: none that is seen
  };
  // [b][a], of that volume's first B-scans; nothing of another one.
  std::span<const Run> of(const pipeline::Volume& volume) const;

private:
  std::vector<Run> runs_;
  const pipeline::Volume* volume_ = nullptr; // is compared with others alone
  std::uint64_t number_ = 0;
  int brought_ = 0; // of its B-scans, from the first one
};

// Of a volume that has flow, at and below where the en-face picture's tissue begins. `out` is [b][a];
// `wanted`: not 0 for B-scans to project, the others stay as they are; empty: all. `ahead`: runs that are
// known. The work is shared among the team.
void project_flow(const pipeline::Volume& volume, const TissueMap& tissue,
                  std::span<FlowFromAbove> out, std::span<const std::uint8_t> wanted = {},
                  std::span<const ComingRuns::Run> ahead = {}, WorkTeam* team = nullptr);

// How deep the hues reach: the smallest of 0.1, 0.2, 0.5, 1, 2 … mm with at most a twentieth of what flows
// below it. Grows at once, and shrinks only where hardly any flow would be left out, so that a vessel
// keeps its hue from volume to volume.
class FlowDepths {
public:
  void follow(std::span<const FlowFromAbove> flow, double volume_depth_mm);

  double deepest_mm() const { return deepest_mm_; }

private:
  double deepest_mm_ = 0; // 0: nothing has flowed yet
};

} // namespace octascope::ui
