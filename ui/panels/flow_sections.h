// What flows of the shown volume in the two crossed B-scans, as textures of counts
// (pipeline/volume/flow_scale.h).
#pragma once

#include <span>
#include <vector>

#include "pipeline/volume/volume.h"
#include "ui/gl/objects.h"

namespace octascope::ui {

// s is depth, t the fast axis or the slow one. Only what is shown of the volume is copied.
//
// Threads: as gl/objects.h. Allocates only when the geometry changes.
class FlowSections {
public:
  // Another volume is shown, or, if it differs from the one before in these B-scans alone, those.
  void note(std::span<const pipeline::BScanRange> changed = {});

  // Copies what is not there yet of the volume that is shown, which has flow, at that B-scan and that
  // A-scan.
  void fetch(const pipeline::Volume& volume, int b_scan, int a_scan);

  GLuint fast() const { return fast_.name(); }
  GLuint slow() const { return slow_.name(); }

private:
  void allocate(const pipeline::VolumeGeometry& geometry);

  gl::Texture fast_;
  gl::Texture slow_;
  pipeline::VolumeGeometry geometry_;
  int b_scan_ = -1;                  // that `fast_` has; −1: none
  int a_scan_ = -1;                  // likewise
  std::vector<std::uint8_t> across_; // [b][depth], to be copied
};

} // namespace octascope::ui
