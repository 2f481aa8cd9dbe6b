// The projection of a volume for the en-face picture. Pure.
#pragma once

#include <cstdint>
#include <span>

#include "pipeline/threads/work_team.h"
#include "pipeline/volume/volume.h"
#include "ui/panels/tissue_map.h"

namespace octascope::ui {

// The depths of one A-scan that the projection takes.
struct Slab {
  int from = 0;
  int count = 0;

  int end() const { return from + count; }
};

// Which those are: see project_slab().
class SlabFinder {
public:
  explicit SlabFinder(const pipeline::VolumeGeometry& geometry);
  Slab slab(const TissueMap::Begin& begin) const;

private:
  int depths_;
  int begin_; // of the slab, from where the brick with the surface begins
  int ahead_; // of what lies behind a gap
  int count_;
};

// The highest level of each A-scan in a slab that follows the surface, just below it, so that
// neither the glare of the surface nor what lies deep hides what a surgeon touches. Where a gap lies
// behind a front layer, such as the anterior chamber behind the cornea, all that lies behind the gap
// is taken instead: iris, lens and instruments. A surface with nothing below it, as an instrument's
// with its shadow, is shown itself.
//
// `out` is [b][a], a_scans · b_scans values. `wanted`: not 0 for B-scans to project, the others stay as
// they are; empty: all. The work is shared among the team.
void project_slab(const pipeline::Volume& volume, const TissueMap& tissue,
                  std::span<std::uint8_t> out, std::span<const std::uint8_t> wanted = {},
                  WorkTeam* team = nullptr);

// Converts projected levels to grey values in place: the darkest 1 % of the received A-scans become
// 0, the brightest 1 % become 255, linear between. The display window is not used: it is for single
// voxels, the highest of which lie in a narrower range.
void stretch_contrast(const pipeline::Volume& volume, std::span<std::uint8_t> levels);

} // namespace octascope::ui
