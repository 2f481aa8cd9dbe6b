// Where a frame's pictures differ from those of the frame before.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pipeline/volume/volume.h"
#include "ui/damage/damage.h"
#include "ui/layout/crop.h"

namespace octascope::ui {

// What the pictures are made of, besides the volume's levels.
struct PictureSources {
  // In the target; empty if it is not shown.
  Rect view;
  Rect b_scan;
  Rect crossed;
  Rect en_face;
  Rect scope;

  pipeline::VolumeGeometry geometry{};
  Crop crop{};
  float window_offset_db = 0;
  float window_size_db = 0;
  int b_scan_index = 0;
  int a_scan_index = 0;
  std::uint64_t scope_uploads = 0;
  bool scope_stale = false;
  bool flow = false;               // is shown
  float deepest_flow = 0;          // how deep its hues reach
  std::uint64_t flow_in_scope = 0; // of which volume; 0: none
};

// Threads: one at a time. Allocates when the number of B-scans grows.
class PictureChanges {
public:
  // Levels or states of the shown volume have changed there.
  void note(const pipeline::BScanRange& changed, int b_scans);
  // The projection from above has changed in the B-scans where `rows` is 1.
  void note_projection(std::span<const std::uint8_t> rows);

  // Adds what is different since the last call, but for what is new in the volume's own picture.
  void compare(const PictureSources& now, Damage& damage);

private:
  bool any_changed(int from, int to) const;

  PictureSources before_;
  // By B-scan: 1 if it has, since the last frame.
  std::vector<std::uint8_t> changed_;
  std::vector<std::uint8_t> projected_;
};

} // namespace octascope::ui
