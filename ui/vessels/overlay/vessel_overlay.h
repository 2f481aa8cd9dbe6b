// A vessel tree within the volume: keeps each eye's picture of it up to date, as the depth mask at
// which the volume's rays end.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "hal/clock.h"
#include "hal/result.h"
#include "pipeline/threads/worker_pool.h"
#include "ui/vessels/overlay/vessel_layer.h"
#include "ui/view/camera.h"
#include "ui/view/segment_counts.h"
#include "ui/view/vessel_placement.h"
#include "ui/view/view_state.h"

namespace octascope::ui {

// Threads: as gl/objects.h, except for the splatter's helpers. Allocates when the size changes, or
// on the first use of an eye or a target.
class VesselOverlay {
public:
  // `clock` measures costs and must outlive the overlay. ErrorCode::unsupported: as
  // Splatter::create().
  static hal::Result<VesselOverlay> create(const pipeline::ThreadSetup& threads,
                                           const hal::Clock& clock);

  // The tree is borrowed until the next show().
  void show(const PlacedVessels& vessels);

  struct Request {
    StereoEye eye;
    const ViewState& view;
    const Camera& camera; // for the volume's extents
    const pipeline::VolumeGeometry& geometry;
    int width; // of the volume's picture
    int height;
    float detail_px; // see SplatShare
    bool occluded;   // see VesselLook
    MaskReader target;
  };
  // Brings the eye's picture up to date. Empty if the view shows no vessels.
  hal::Result<std::optional<DepthMask>> update(const Request& request);

  // Whether vessels are shown without a registration to the volume.
  bool shows_unregistered(const ViewState& view) const {
    return shows(view) && !vessels_.volume_from_tree;
  }

  // Of the last picture.
  const SegmentCounts& account() const { return account_; }
  // The time spent on drawing vessels since create().
  hal::Duration spent() const { return spent_; }

private:
  VesselOverlay(Splatter splatter, const hal::Clock& clock)
      : splatter_{std::move(splatter)}, clock_{&clock} {}
  bool shows(const ViewState& view) const;

  Splatter splatter_;
  const hal::Clock* clock_;
  PlacedVessels vessels_;
  std::uint64_t shown_ = 0;
  std::array<VesselLayer, 2> layers_; // the second is the right eye's
  SegmentCounts account_;
  hal::Duration spent_{};
};

} // namespace octascope::ui
