// Draws vessel trees on the processor: each segment's rounded trapezoid
// (ui/vessels/scene/vessel_scene.h) in the pixels whose centres it covers, the nearest in front.
// The result does not depend on the drawing order, so threads share one picture and it is the same
// to the bit.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>

#include "hal/result.h"
#include "pipeline/threads/work_team.h"
#include "pipeline/threads/worker_pool.h"
#include "ui/depth_mask/depth_image.h"
#include "ui/vessels/scene/vessel_scene.h"
#include "ui/vessels/splatter/splat_kernels.h"
#include "ui/view/segment_counts.h"

namespace octascope::ui {

struct SplatShare {
  // Per cluster, the number of its first nodes, references included, whose segments are drawn
  // elsewhere. Empty: all are drawn here.
  std::span<const std::uint8_t> taken;
  // Segments with a smaller radius in pixels are merged (merged_order.h), but none of order
  // least_order_kept_visible and above. 0: none.
  float detail_px = 0;
};

// Threads: bound to one, but for its own helpers. draw() allocates nothing but the image.
class Splatter {
public:
  // `helpers` threads besides the caller's. `isa` names an instruction set; empty: the widest.
  // ErrorCode::unsupported: none that this processor has is compiled in.
  static hal::Result<Splatter> create(std::size_t helpers, const pipeline::ThreadSetup& setup,
                                      std::string_view isa = {});

  // Draws into `image`, resized to the scene's size. Counts the segments that are not taken.
  // ErrorCode::invalid_argument: the scene has no pixels, or `taken` has another length than there
  // are clusters.
  hal::Result<SegmentCounts> draw(const VesselScene& scene, DepthImage& image,
                                  const SplatShare& share = {});

  std::string_view isa() const { return kernels_->isa; }

private:
  Splatter(const SplatKernels& kernels, std::unique_ptr<WorkTeam> team)
      : kernels_{&kernels}, team_{std::move(team)} {}

  const SplatKernels* kernels_;
  std::unique_ptr<WorkTeam> team_;
};

} // namespace octascope::ui
