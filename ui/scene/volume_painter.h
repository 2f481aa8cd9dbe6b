// The volume on the display: takes volumes, keeps one picture per eye, and has GL or the processor
// draw it.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>

#include "hal/result.h"
#include "pipeline/threads/worker_pool.h"
#include "pipeline/volume/occupancy.h"
#include "pipeline/volume/volume.h"
#include "ui/layout/layout.h"
#include "ui/transfer/transfer_set.h"
#include "ui/transfer/transfer_texture.h"
#include "ui/vessels/overlay/vessel_overlay.h"
#include "ui/view/draw_quality.h"
#include "ui/view/view_state.h"
#include "ui/volume/ray_cast_picture.h"
#include "ui/volume/volume_picture.h"

namespace octascope::ui {

// Threads: as gl/objects.h, but for the ray caster's own helpers. Allocates when the size or the
// geometry changes, or a technique, an eye or a backend is first used.
class VolumePainter {
public:
  // `threads` is kept and called on each thread that is started here, now or later: "rays"
  // (several: the ray caster's helpers) and "surface" (the iso-surface's). ErrorCode::unsupported:
  // this GL cannot compile our shaders.
  static hal::Result<VolumePainter> create(const TransferSet& transfers = {},
                                           const pipeline::ThreadSetup& threads = {});

  // Copies the volume and, if known already (without the blank depth bins), its occupancy, which is
  // otherwise computed. ErrorCode::invalid_argument: the occupancy is of another geometry. After
  // this or an error of VolumeTexture::upload() the last volume stays.
  hal::Result<> show(const pipeline::Volume& volume);
  hal::Result<> show(const pipeline::Volume& volume, const pipeline::Occupancy& occupancy);

  // From the next update() on, if the view shows vessels. The tree stays borrowed until another is
  // shown; an empty one shows none. `clock` must outlive this. ErrorCode::unsupported: this
  // processor cannot draw vessels.
  hal::Result<> show_vessels(const PlacedVessels& vessels, const hal::Clock& clock);
  const VesselOverlay* vessels() const { return vessels_ ? &*vessels_ : nullptr; }

  // Prepares the processor to cast the rays of volumes shown from now on.
  void want_processor();

  // Brings the eye's picture up to date; `camera` is that eye's, for the rectangle's aspect.
  hal::Result<> update(StereoEye eye, const ViewState& view, const Camera& camera,
                       const DrawQuality& quality, const Rect& rect);
  // Blends it over the bound framebuffer.
  void composite(StereoEye eye, const Rect& rect, int target_height) const;

  // Whether the view needs data not computed for the shown volume: then show() it again.
  bool wants_volume(const ViewState& view) const;
  // Whether update() would make another picture of the same volume and view: a mesh has been
  // finished.
  bool has_newer(const ViewState& view) const;
  // Waits until update() has everything for the view at that quality (a mesh, the processor's copy
  // of the volume): for commands and tests. `volume` is the one shown last.
  hal::Result<> finish(const pipeline::Volume& volume, const ViewState& view,
                       const DrawQuality& quality = {});

  bool empty() const { return texture_.empty(); }
  const VolumeTexture& texture() const { return texture_; }
  std::uint64_t uploads() const { return uploads_; } // counts the volumes shown

  // Counts the pictures that update() made; none if nothing changed.
  std::uint64_t drawings() const;

  // Which backend casts rays at that quality. The processor always if GL is software, else from the
  // first volume shown after it was first requested; never for volumes too large for the ray
  // caster, or on a processor that it does not support.
  RayBackend backend(const DrawQuality& quality) const;

private:
  struct EyePictures {
    VolumePicture by_gl;
    std::optional<VolumePicture> alone_by_gl; // if vessels are not opaque
    std::optional<RayCastPicture> by_processor;
    bool processor_drew = false; // in the last update()
  };

  VolumePainter(bool software, const TransferSet& transfers, const pipeline::ThreadSetup& threads);
  void make_caster();
  hal::Result<EyePictures*> pictures_of(StereoEye eye);
  void update_transfer(const ViewState& view);
  hal::Result<std::optional<DepthMask>> update_vessels(StereoEye eye, const VolumeScene& scene,
                                                       const DrawQuality& quality, const Rect& rect,
                                                       MaskReader target);
  hal::Result<> draw_by_gl(EyePictures& pictures, const VolumeScene& scene,
                           const DrawQuality& quality, const Rect& rect);
  hal::Result<> cast_rays(EyePictures& pictures, const VolumeScene& scene,
                          const DrawQuality& quality, const Rect& rect);

  // What the transfer function was made of.
  struct TransferSource {
    float window_offset_db;
    float window_size_db;
    float opacity;
    int transfer;
    int colour_map;
    bool operator==(const TransferSource&) const = default;
  };

  bool software_;
  TransferSet transfers_;
  pipeline::ThreadSetup threads_;
  VolumeTexture texture_;
  pipeline::Occupancy occupancy_;
  pipeline::Occupancy own_occupancy_; // for volumes that come without
  std::uint64_t uploads_ = 0;
  std::unique_ptr<TransferTable> transfer_;
  TransferTexture transfer_texture_;
  std::optional<TransferSource> transfer_source_;
  VolumeTechniques techniques_;
  std::optional<VesselOverlay> vessels_; // empty until some are shown
  std::optional<RayCaster> caster_;      // empty until it is wanted
  bool caster_wanted_ = false;
  bool caster_shows_ = false; // it holds the same volume as the texture
  bool surface_shows_ = false;
  std::array<std::optional<EyePictures>, 2> pictures_; // the second is the right eye's
};

} // namespace octascope::ui
