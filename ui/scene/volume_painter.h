// Shows the volume: keeps one picture of it per eye, drawn by GL or by the processor.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "hal/result.h"
#include "pipeline/threads/worker_pool.h"
#include "pipeline/volume/cover.h"
#include "pipeline/volume/occupancy.h"
#include "pipeline/volume/volume.h"
#include "ui/layout/layout.h"
#include "ui/scene/coming_volume.h"
#include "ui/scene/cut_face.h"
#include "ui/transfer/transfer_set.h"
#include "ui/transfer/transfer_texture.h"
#include "ui/vessels/overlay/vessel_overlay.h"
#include "ui/view/draw_quality.h"
#include "ui/view/view_state.h"
#include "ui/volume/ray_cast_picture.h"
#include "ui/volume/volume_picture.h"

namespace octascope::ui {

// The size of a technique's window beside the view's, and how much of the view's lies below it. Of
// many speckles along a ray, a maximum finds the brightest: it would be white all over. Shading takes
// a share of the light.
constexpr float window_stretch(Technique technique) {
  switch (technique) {
  case Technique::maximum: return 1.2F;
  case Technique::shaded: return 0.9F;
  default: return 1;
  }
}
constexpr float window_lift(Technique technique) {
  return technique == Technique::maximum ? 0.3F : 0;
}

// Threads: as gl/objects.h, except for the ray caster's own helpers. Allocates when the size or the
// geometry changes, or when a technique, an eye or a backend is first used.
class VolumePainter {
public:
  // `threads` is kept and called on each thread started here, now or later: "rays" (several: those
  // that help to draw) and "surface" (the iso-surface's). ErrorCode::unsupported: this GL cannot
  // compile the shaders.
  static hal::Result<VolumePainter> create(const TransferSet& transfers = {},
                                           const pipeline::ThreadSetup& threads = {});

  // Copies the volume and its occupancy (without the blank depth bins); computes the occupancy if
  // it is not given. ErrorCode::invalid_argument: the occupancy has another geometry. After that
  // and after the errors of VolumeTexture::upload(), the previous volume stays.
  hal::Result<> show(const pipeline::Volume& volume);
  hal::Result<> show(const pipeline::Volume& volume, const pipeline::Occupancy& occupancy);

  // The same where the volume, which has an occupancy, differs from the one shown last in these
  // B-scans alone: only what depends on them is renewed. The iso-surface stays that of the last
  // show(). Drawn weaker is what the cover of the last whole volume says, found anew when the last
  // B-scan is renewed. Light (of "shaded") is computed anew as a whole.
  hal::Result<> renew(const pipeline::Volume& volume,
                      std::span<const pipeline::BScanRange> changed);

  // Copies what it can of a volume that is going to be shown: of the first `finished` B-scans, which stay as
  // they are, and reads none of the others. show() then copies the rest. `shown` must be the volume shown last;
  // `number`: what will be the other's VolumeMetadata::index.
  void bring_ahead(const pipeline::Volume& coming, std::uint64_t number, int finished,
                   const pipeline::Volume& shown);

  // From the next update() on, if the view shows vessels. The tree is borrowed until others are
  // shown; an empty one shows none. `clock` must outlive the painter. ErrorCode::unsupported: this
  // processor cannot draw vessels.
  hal::Result<> show_vessels(const PlacedVessels& vessels, const hal::Clock& clock);
  const VesselOverlay* vessels() const { return vessels_ ? &*vessels_ : nullptr; }

  // Prepares the processor to cast the rays of all volumes shown from now on.
  void want_processor();

  // The depths that a picture coloured by depth spreads its hues over, from the next update() on.
  void colour_depths(const DepthColours& depths) { depths_ = depths; }
  // Those of the view, if its colours are those of depths.
  std::optional<DepthColours> depth_colours(const ViewState& view) const {
    return transfers_.colours(view).by_depth() ? std::optional{depths_} : std::nullopt;
  }

  // Copies what drawing that view at that quality needs of the shown volume and is not there yet;
  // `volume` must be the one shown last, and nothing of it be wanted (below). From the first call on, show() and renew() leave out what
  // the view expected does not need, and it must be called before each update().
  hal::Result<> complete(const pipeline::Volume& volume, const ViewState& view,
                         const DrawQuality& quality);

  // Whether what flows is drawn for that view: it shows flow, and the shown volume has some. That was
  // computed unless wants_volume().
  bool draws_flow(const ViewState& view) const {
    return flow_shows_ && !flow_refusal_ && shows_flow(view);
  }

  // Whether the surface was drawn without its flow, as its mesh came after the flow had gone, in one of
  // the last volumes: of so many that it does not go and come with each.
  bool flow_late(const ViewState& view) const {
    return view.technique == Technique::surface && draws_flow(view) && flow_late_until_ > uploads_;
  }

  // Whether what flows in the shown volume was computed: it was to be shown then.
  bool has_flow_computed() const { return flow_shows_; }

  // Compiles what GL draws flow with by that technique. Where it cannot, as update() for another
  // technique, no flow is drawn any more. ErrorCode::unsupported: it cannot.
  hal::Result<> prepare_flow(Technique technique);
  void refuse_flow(hal::Error why);
  // Empty: flow can be drawn, as far as was tried.
  const std::optional<hal::Error>& flow_refusal() const { return flow_refusal_; }

  // Brings the eye's picture up to date; `camera` must be that eye's, with the rectangle's aspect.
  // ErrorCode::invalid_argument: complete() was not called for it.
  hal::Result<> update(StereoEye eye, const ViewState& view, const Camera& camera,
                       const DrawQuality& quality, const Rect& rect);
  // Blends the eye's picture over the bound framebuffer.
  void composite(StereoEye eye, const Rect& rect, int target_height) const;

  // Adds what of `rect` composite() draws in another way since the update() before the last one of
  // that eye. The rectangle must be that of both.
  void add_changed(StereoEye eye, const Rect& rect, Damage& damage) const;

  // What volumes are going to be seen with: show() computes what that needs.
  void expect(const ViewState& view);
  // Whether the view needs data that was not computed for the shown volume. If so, show() it again.
  bool wants_volume(const ViewState& view) const;
  // Whether update() would redraw the same volume and view, because a mesh has been finished.
  bool has_newer(const ViewState& view) const;
  // Waits until update() has everything for the view at that quality (a mesh, the processor's copy
  // of the volume): for commands and tests. `volume` must be the one shown last, if there is one.
  hal::Result<> finish(const pipeline::Volume& volume, const ViewState& view,
                       const DrawQuality& quality = {});

  bool empty() const { return texture_.empty(); }
  const VolumeTexture& texture() const { return texture_; } // as it came, nothing drawn weaker
  const pipeline::Occupancy& occupancy() const { return occupancy_; } // of the shown volume
  std::uint64_t uploads() const { return uploads_; }                  // the number of volumes shown

  // The drawing threads, for other work between two pictures.
  WorkTeam* team() { return team_.get(); }

  // The number of pictures that update() drew; unchanged pictures are not redrawn.
  std::uint64_t drawings() const;

  // What casts the rays at that quality: `quality.rays`, by default the processor if GL is software
  // and else the shader. Always the shader until a volume was shown after the processor was first
  // requested, for volumes that are too large for the ray caster, and if the ray caster supports
  // none of the processor's instruction sets.
  RayBackend backend(const DrawQuality& quality) const;

private:
  struct EyePictures {
    VolumePicture by_gl;
    std::optional<VolumePicture> alone_by_gl; // without vessels, if these are not opaque
    std::optional<RayCastPicture> by_processor;
    bool processor_drew = false; // in the last update()
    Camera camera{};             // of the last update()
    CutAway cut_away{};
    bool flow = false;
    bool all_changed = true; // by the last update()
  };

  VolumePainter(bool software, const TransferSet& transfers, const pipeline::ThreadSetup& threads);
  void make_caster();
  bool must_show_all(const pipeline::Volume& volume) const;
  void renew_occupancy(const pipeline::Volume& volume, const pipeline::BScanRange& range);
  const pipeline::Volume& see_through(const pipeline::Volume& volume);
  void weaken(const pipeline::Volume& volume, int b_scan);
  void copy_for_rays(const pipeline::Volume& volume);
  bool copy_rest_for_rays(const pipeline::Volume& volume, int brought);
  hal::Result<> renew_for_rays(const pipeline::Volume& volume,
                               std::span<const pipeline::BScanRange> changed);
  void prepare_b_scan(const pipeline::Volume& volume, int b_scan);
  void prepare_b_scans(const pipeline::Volume& volume, const pipeline::BScanRange& range);
  bool needs_flow_texture(const ViewState& view, RayBackend rays) const;
  hal::Result<> bring_flow_texture(const pipeline::Volume& volume, const TextureParts& parts);
  hal::Result<> make_flow_programs(Technique technique, bool by_gl);
  FlowScene flow_scene(float view_opacity) const;
  bool match_flow(FlowScene& flow);
  TextureParts expected_parts() const;
  TextureParts parts_for(const ViewState& view, RayBackend rays) const;
  TextureParts level_parts_for(const ViewState& view, RayBackend rays) const;
  hal::Result<const VolumeTexture*> drawn_texture();
  hal::Result<EyePictures*> pictures_of(StereoEye eye);
  void update_transfer(const ViewState& of);
  const LightVolume* light_for(const ViewState& of);
  hal::Result<std::optional<DepthMask>> update_vessels(StereoEye eye, const VolumeScene& scene,
                                                       const DrawQuality& quality, const Rect& rect,
                                                       MaskReader target);
  hal::Result<> draw_by_gl(EyePictures& pictures, const VolumeScene& scene,
                           const DrawQuality& quality, const Rect& rect);
  hal::Result<> cast_rays(EyePictures& pictures, const VolumeScene& scene,
                          const DrawQuality& quality, const Rect& rect);

  // The inputs of the transfer function.
  struct TransferSource {
    float window_offset_db;
    float window_size_db;
    float opacity;
    int transfer;
    int colour_map;
    DepthColours depths;
    bool operator==(const TransferSource&) const = default;
  };

  bool software_;
  TransferSet transfers_;
  pipeline::ThreadSetup threads_;
  std::shared_ptr<WorkTeam> team_; // the ray caster works with it, too
  VolumeTexture texture_;
  TextureParts expected_; // of it, where the caller completes them
  bool completed_by_caller_ = false;
  pipeline::Occupancy occupancy_;
  pipeline::Occupancy own_occupancy_; // for volumes that come without one
  std::uint64_t uploads_ = 0;
  std::vector<pipeline::BScanRange> changed_; // by the last upload; empty: everything
  // The volume with its cover drawn weaker.
  pipeline::Cover cover_;
  pipeline::Volume weakened_;
  VolumeTexture weakened_texture_; // made when GL first draws it
  std::uint64_t weakened_uploads_ = 0;
  bool weakened_shows_ = false;
  // What flows, if the view shows that.
  VolumeTexture flow_texture_{Voxels::flow}; // of the volume whose upload this was:
  std::uint64_t flow_uploads_ = 0;
  std::uint64_t flow_before_ = 0;     // likewise, of its texture before; 0: not all of it is there
  bool flow_whole_ = false;           // all of it was uploaded
  std::uint64_t flow_late_until_ = 0; // before this upload
  pipeline::FlowMarks flow_marks_;
  bool flow_wanted_ = shows_flow(ViewState{});
  std::optional<hal::Error> flow_refusal_; // why none is drawn
  bool has_flow_ = false;                  // the volume shown
  bool flow_shows_ = false;
  float see_through_db_ = ViewState{}.see_through_db; // of the last view
  float shown_see_through_db_ = 0;                    // of the volume shown
  std::unique_ptr<TransferTable> transfer_;
  TransferTexture transfer_texture_;
  std::optional<TransferSource> transfer_source_;
  DepthColours depths_;
  VolumeTechniques techniques_;
  std::optional<CutFace> cut_face_;      // empty until a view is cut
  std::optional<CutFace> flow_cut_face_; // likewise with flow
  std::optional<VesselOverlay> vessels_; // empty until some are shown
  std::optional<RayCaster> caster_;      // empty until requested
  ComingVolume coming_;
  bool caster_wanted_ = false;
  bool caster_shows_ = false; // the same volume as the texture
  bool surface_shows_ = false;
  LightVolume light_; // of the volume shown
  bool light_wanted_ = false;
  bool light_shows_ = false;
  std::array<std::optional<EyePictures>, 2> pictures_; // the second is the right eye's
};

} // namespace octascope::ui
