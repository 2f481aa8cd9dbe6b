#include "ui/vessels/overlay/vessel_overlay.h"

#include <algorithm>
#include <thread>
#include <utility>

#include "ui/ray_caster/ray_frame.h"
#include "ui/ray_caster/ray_geometry.h"

namespace octascope::ui {

namespace {

// As the volume's own depth cue.
VesselLook look_of(const VesselOverlay::Request& request) {
  const RayGeometry rays = ray_geometry(request.geometry, request.camera);
  return {request.view.vessel_colouring, depth_cue, rays.cue_near_mm,
          rays.cue_near_mm + 1 / rays.cue_per_mm, request.occluded};
}

} // namespace

hal::Result<VesselOverlay> VesselOverlay::create(const pipeline::ThreadSetup& threads,
                                                 const hal::Clock& clock) {
  constexpr unsigned most_helpers = 15;
  const unsigned helpers =
      std::clamp(std::thread::hardware_concurrency(), 1U, most_helpers + 1) - 1;
  HAL_TRY(auto splatter, Splatter::create(helpers, threads));
  return VesselOverlay{std::move(splatter), clock};
}

void VesselOverlay::show(const PlacedVessels& vessels) {
  vessels_ = vessels;
  ++shown_;
}

bool VesselOverlay::shows(const ViewState& view) const {
  return shows_tree(view) && view.vessel_opacity > 0 && !vessels_.tree.clusters.empty();
}

hal::Result<std::optional<DepthMask>> VesselOverlay::update(const Request& request) {
  const ViewState& view = request.view;
  if (!shows(view))
    return std::nullopt;
  VesselLayer& layer = layers_[request.eye == StereoEye::right ? 1 : 0];
  const VesselScene scene{vessels_.tree,
                          request.camera,
                          world_from_tree(vessels_, view.vessel_nudge, request.geometry),
                          look_of(request),
                          request.width,
                          request.height};
  const std::uint64_t drawings = layer.drawings();
  const hal::TimePoint begin = clock_->now();
  HAL_CHECK(layer.update(splatter_, scene, shown_, request.detail_px, request.target));
  if (layer.drawings() != drawings)
    spent_ += clock_->now() - begin;
  account_ = layer.account();
  return layer.stops(request.target, view.vessel_opacity);
}

} // namespace octascope::ui
