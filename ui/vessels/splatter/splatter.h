// Draws vessel trees on the processor: each segment's rounded trapezoid
// (ui/vessels/scene/vessel_scene.h) in the pixels whose centres it covers, nearest in front. The
// drawing order does not matter: threads share one picture, and the result is the same to the bit.
// A second pass smooths it (splat_outline.h): along outlines a pixel mixes with its neighbour by
// the share that is covered, and what is thinner than a pixel becomes the grey that it stands for.
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
#include "ui/vessels/splatter/occlusion_field.h"
#include "ui/vessels/splatter/splat_kernels.h"
#include "ui/view/segment_counts.h"

namespace octascope::ui {

struct SplatShare {
  // Per cluster: the number of first nodes, references included, whose segments are drawn
  // elsewhere. Empty: all are drawn here.
  std::span<const std::uint8_t> taken;
  // Segments with a smaller radius in pixels are merged (merged_order.h), except those of order
  // least_order_kept_visible and above. 0: none.
  float detail_px = 0;
  // The picture ends a volume's rays: a pixel whose centre a vessel covers stays opaque, since there
  // is no tissue to mix with where rays end, and a vessel thinner than a pixel stays sharp beside
  // pixels without one.
  bool within_volume = false;
};

// Threads: bound to one, except for its own helpers. draw() allocates only the image and
// pictures of its size, to grow.
class Splatter {
public:
  // `helpers`: threads besides the caller's. `isa` names an instruction set; by default the widest
  // is used. ErrorCode::unsupported: none of the compiled ones is available on this processor.
  static hal::Result<Splatter> create(std::size_t helpers, const pipeline::ThreadSetup& setup,
                                      std::string_view isa = {});

  // Draws into `image`, which is resized to the scene's size: colours premultiplied by coverage,
  // distances of what covers a pixel's centre. The counts cover the segments that
  // are not taken. ErrorCode::invalid_argument: the scene has no pixels, or `taken` has not one
  // entry per cluster.
  hal::Result<SegmentCounts> draw(const VesselScene& scene, DepthImage& image,
                                  const SplatShare& share = {});

  // Of the last draw(): no other column has a vessel.
  SplatColumns columns() const { return columns_; }

  std::string_view isa() const { return kernels_->isa; }
  // Of the last draw(): what each pixel's centre shows (splat_outline.h).
  const DepthImage& sharp() const { return sharp_; }

private:
  Splatter(const SplatKernels& kernels, std::unique_ptr<WorkTeam> team)
      : kernels_{&kernels}, team_{std::move(team)} {}

  OcclusionMoments occlude(const VesselScene& scene);

  const SplatKernels* kernels_;
  std::unique_ptr<WorkTeam> team_;
  DepthImage sharp_;
  SplatColumns columns_;
  OcclusionField occlusion_;
};

} // namespace octascope::ui
