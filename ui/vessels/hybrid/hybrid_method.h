// GL draws wide vessels and the processor thin ones, at the same time and into one depth.
//
// The idea of sharing a vessel tree is the thesis's (docs/VESSELS.md); the split is by projected
// radius.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>

#include "hal/result.h"
#include "pipeline/threads/worker_pool.h"
#include "ui/vessels/hybrid/detail_governor.h"
#include "ui/vessels/hybrid/gl_share.h"
#include "ui/vessels/scene/vessel_method.h"
#include "ui/vessels/splatter/splat_picture.h"
#include "ui/vessels/splatter/splatter.h"
#include "ui/view/segment_counts.h"

namespace octascope::ui {

// Threads: bound to the thread of its GL context, but for the splatter's helpers.
class HybridMethod final : public VesselMethod {
public:
  // GL's share: segments of at least `gl_radius_px`.
  struct Share {
    std::unique_ptr<GlShare> gl; // nullptr: the processor draws everything, as with software GL
    float gl_radius_px = 1.5F;
  };

  static hal::Result<HybridMethod> create(std::size_t helpers, const pipeline::ThreadSetup& setup,
                                          Share share);

  // For the frames that follow; see SplatShare::detail_px. Ends hold_frame_time().
  void set_detail_px(float detail_px) {
    governor_.reset();
    detail_px_ = detail_px;
  }

  // Merges vessels only as far as needed to keep the cost of frames, as reported by note_cost(),
  // within the target; see DetailGovernor. May be called again at any time.
  void hold_frame_time(hal::Duration target);
  // The cost of the whole last frame, whatever else was in it.
  void note_cost(hal::Duration cost);
  // Where nothing moves, a frame may take its time and shows every vessel.
  void set_at_rest(bool at_rest) { at_rest_ = at_rest; }

  // The radius below which vessels were merged in the last frame, for display. 0: none were merged.
  float shown_detail_px() const { return shown_detail_px_; }

  // The processor's part of the last frame, with distances.
  const DepthImage& splats() const { return image_; }

private:
  HybridMethod(Splatter splatter, SplatPicture picture, Share share)
      : splatter_{std::move(splatter)}, picture_{std::move(picture)}, share_{std::move(share)} {}
  hal::Result<SegmentCounts> do_draw(const VesselScene& scene) override;

  Splatter splatter_;
  SplatPicture picture_;
  Share share_;
  DepthImage image_;
  VesselSplit split_; // empty if GL has no share
  std::optional<DetailGovernor> governor_;
  bool at_rest_ = false;
  float detail_px_ = 0;
  float shown_detail_px_ = 0;
};

} // namespace octascope::ui
