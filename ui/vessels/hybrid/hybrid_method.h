// GL draws wide segments and the processor thin ones, at the same time and into one depth.
//
// The idea of sharing a vessel tree between both is from the thesis (docs/VESSELS.md); here they
// are split by projected radius.
#pragma once

#include <cstddef>
#include <memory>

#include "hal/result.h"
#include "pipeline/threads/worker_pool.h"
#include "ui/vessels/hybrid/gl_share.h"
#include "ui/vessels/scene/vessel_method.h"
#include "ui/vessels/splatter/splat_picture.h"
#include "ui/vessels/splatter/splatter.h"
#include "ui/view/segment_counts.h"

namespace octascope::ui {

// Threads: bound to the thread of its GL context, except for the splatter's helpers.
class HybridMethod final : public VesselMethod {
public:
  // GL's share: segments of at least `gl_radius_px`.
  struct Share {
    std::unique_ptr<GlShare> gl; // nullptr: the processor draws everything, as for software GL
    float gl_radius_px = 1.5F;
  };

  static hal::Result<HybridMethod> create(std::size_t helpers, const pipeline::ThreadSetup& setup,
                                          Share share);

  // For the following frames; see SplatShare::detail_px.
  void set_detail_px(float detail_px) { detail_px_ = detail_px; }

  // What the processor drew in the last frame, with distances.
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
  float detail_px_ = 0;
};

} // namespace octascope::ui
