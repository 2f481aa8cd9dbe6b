#include "ui/scene/volume_painter.h"

#include <algorithm>
#include <thread>
#include <utility>

#include "pipeline/volume/level_scale.h"
#include "pipeline/volume/volume_geometry.h"
#include "ui/gl/context_info.h"
#include "ui/transfer/flow_look.h"

namespace octascope::ui {

namespace {

// How the ray casters draw a technique; nothing for those that only GL knows.
std::optional<RayMode> ray_mode(Technique technique) {
  switch (technique) {
  case Technique::rays: return RayMode::composite;
  case Technique::shaded: return RayMode::shaded;
  case Technique::maximum: return RayMode::maximum;
  case Technique::slices:
  case Technique::planes:
  case Technique::surface: break;
  }
  return std::nullopt;
}

bool cast_by_processor(const ViewState& view, RayBackend rays) {
  return ray_mode(view.technique) && rays == RayBackend::processor;
}

// From the texture of the volume, or of the one whose cover is weaker; a surface is made of neither.
bool sampled_by_gl(const ViewState& view, RayBackend rays) {
  return view.technique != Technique::surface && !cast_by_processor(view, rays);
}

ViewState stretched(ViewState view) {
  view.window_offset_db += window_lift(view.technique) * view.window_size_db;
  view.window_size_db *= window_stretch(view.technique);
  return view;
}

// With the calling thread, one for each core.
std::shared_ptr<WorkTeam> make_team(const pipeline::ThreadSetup& threads) {
  constexpr unsigned most_helpers = 15;
  const unsigned helpers =
      std::clamp(std::thread::hardware_concurrency(), 1U, most_helpers + 1) - 1;
  return std::make_shared<WorkTeam>(helpers, threads);
}

std::size_t index_of(StereoEye eye) {
  return eye == StereoEye::right ? 1 : 0;
}

} // namespace

hal::Result<VolumePainter> VolumePainter::create(const TransferSet& transfers,
                                                 const pipeline::ThreadSetup& threads) {
  VolumePainter painter{gl::describe_context().software, transfers, threads};
  // What every view needs is made here, so that a GL that cannot do it is known at once.
  HAL_CHECK(painter.pictures_of(StereoEye::left));
  HAL_CHECK(painter.techniques_.get(ViewState{}.technique));
  if (painter.software_)
    painter.make_caster();
  return painter;
}

VolumePainter::VolumePainter(bool software, const TransferSet& transfers,
                             const pipeline::ThreadSetup& threads)
    : software_{software}, transfers_{transfers}, threads_{threads}, team_{make_team(threads)},
      transfer_{std::make_unique<TransferTable>()}, techniques_{transfers, threads} {}

hal::Result<VolumePainter::EyePictures*> VolumePainter::pictures_of(StereoEye eye) {
  auto& kept = pictures_[index_of(eye)];
  if (!kept) {
    HAL_TRY(auto made, VolumePicture::create());
    kept = EyePictures{std::move(made), std::nullopt, std::nullopt};
  }
  return &*kept;
}

hal::Result<> VolumePainter::show(const pipeline::Volume& volume) {
  if (!volume.occupancy.empty())
    return show(volume, volume.occupancy);
  if (own_occupancy_.geometry() != volume.geometry)
    own_occupancy_ = pipeline::Occupancy{volume.geometry, pipeline::blank_depth_bins};
  if (volume.levels.size() == volume.geometry.voxels()) // else refused below
    own_occupancy_.update(volume);
  return show(volume, own_occupancy_);
}

hal::Result<> VolumePainter::show(const pipeline::Volume& volume,
                                  const pipeline::Occupancy& occupancy) {
  if (occupancy.geometry() != volume.geometry)
    return hal::fail(hal::ErrorCode::invalid_argument,
                     "volume display: found the occupancy of a volume of another shape, expected "
                     "that of the one to be shown");
  HAL_CHECK(texture_.upload(volume, expected_parts()));
  occupancy_ = occupancy;
  ++uploads_;
  changed_.clear();
  changed_.reserve(volume.b_scan_states.size());
  const pipeline::Volume& drawn = see_through(volume);
  has_flow_ = volume.has_flow();
  flow_shows_ = has_flow_ && flow_wanted_;
  if (flow_shows_ && flow_marks_.geometry() != volume.geometry)
    flow_marks_ = pipeline::FlowMarks{volume.geometry, pipeline::blank_depth_bins};
  copy_for_rays(volume);
  if (flow_shows_ && !completed_by_caller_)
    HAL_CHECK(bring_flow_texture(volume, {}));
  light_shows_ = light_wanted_;
  if (light_shows_)
    light_.show(drawn);
  surface_shows_ = techniques_.surface() != nullptr;
  if (surface_shows_)
    techniques_.surface()->show(volume, cover_, // whole: what is left of a cover would be in pieces
                                uploads_);
  return {};
}

// What was never shown as a whole, or is seen through in another way, has nothing to be renewed.
bool VolumePainter::must_show_all(const pipeline::Volume& volume) const {
  return empty() || volume.geometry != texture_.geometry() || volume.has_flow() != has_flow_ ||
         (has_flow_ && flow_wanted_ != flow_shows_) || light_wanted_ != light_shows_ ||
         see_through_db_ != shown_see_through_db_ || (caster_ && !caster_shows_);
}

void VolumePainter::renew_occupancy(const pipeline::Volume& volume,
                                    const pipeline::BScanRange& range) {
  for (int b = range.from; b < range.to; ++b)
    occupancy_.copy(b, volume.occupancy);
  if (range.to == volume.geometry.b_scans && see_through_db_ > 0)
    cover_.find(occupancy_);
  if (!weakened_shows_)
    return;
  const int widened = static_cast<int>(see_through_db_ / pipeline::level_step_db) + 1;
  for (int b = range.from; b < range.to; ++b) {
    const auto at = static_cast<std::size_t>(b);
    weakened_.b_scan_states[at] = volume.b_scan_states[at];
    occupancy_.widen_below(b, widened);
  }
}

hal::Result<> VolumePainter::renew(const pipeline::Volume& volume,
                                   std::span<const pipeline::BScanRange> changed) {
  if (must_show_all(volume))
    return show(volume);
  for (const pipeline::BScanRange& range : changed)
    renew_occupancy(volume, range);
  if (see_through_db_ > 0 && weakened_shows_ == cover_.empty())
    return show(volume); // a cover appeared, or went
  HAL_CHECK(texture_.renew(volume, changed, expected_parts()));
  ++uploads_;
  changed_.assign(changed.begin(), changed.end());
  HAL_CHECK(renew_for_rays(volume, changed));
  if (flow_shows_ && !completed_by_caller_)
    HAL_CHECK(bring_flow_texture(volume, {}));
  if (light_shows_)
    light_.show(weakened_shows_ ? weakened_ : volume);
  surface_shows_ = false;
  return {};
}

// The volume to draw; widens the occupancy to its levels.
const pipeline::Volume& VolumePainter::see_through(const pipeline::Volume& volume) {
  shown_see_through_db_ = see_through_db_;
  if (see_through_db_ > 0)
    cover_.find(occupancy_);
  else
    cover_.clear();
  weakened_shows_ = !cover_.empty();
  if (!weakened_shows_)
    return volume;
  if (weakened_.geometry != volume.geometry)
    weakened_ = pipeline::Volume{volume.geometry};
  weakened_.b_scan_states = volume.b_scan_states;
  occupancy_.widen_below(static_cast<int>(see_through_db_ / pipeline::level_step_db) + 1);
  return weakened_;
}

void VolumePainter::weaken(const pipeline::Volume& volume, int b_scan) {
  cover_.weaken(b_scan, volume.b_scan(b_scan), see_through_db_ / pipeline::level_step_db,
                weakened_.b_scan(b_scan));
}

// By the thread that copies the B-scan, which then has it in its cache.
void VolumePainter::prepare_b_scan(const pipeline::Volume& volume, int b_scan) {
  if (weakened_shows_)
    weaken(volume, b_scan);
  if (!flow_shows_)
    return;
  if (volume.flow_marks.empty())
    flow_marks_.update(b_scan, volume.b_scan_flow(b_scan));
  else
    flow_marks_.copy(b_scan, volume.flow_marks);
}

void VolumePainter::prepare_b_scans(const pipeline::Volume& volume,
                                    const pipeline::BScanRange& range) {
  if (weakened_shows_ || flow_shows_)
    team_->run(static_cast<std::uint32_t>(range.to - range.from),
               [&](std::uint32_t i) { prepare_b_scan(volume, range.from + static_cast<int>(i)); });
}

hal::Result<> VolumePainter::prepare_flow(Technique technique) {
  const auto made = make_flow_programs(technique, !(software_ && ray_mode(technique)));
  if (!made)
    refuse_flow(made.error());
  return made;
}

// Of two sections the flat pictures and a cut's faces are made; all else the processor draws from its own copy.
TextureParts VolumePainter::parts_for(const ViewState& view, RayBackend rays) const {
  return {.all = !cast_by_processor(view, rays), .b_scan = view.b_scan, .a_scan = view.a_scan};
}

// Where a cover is drawn weaker, GL draws the volume from that one's texture.
TextureParts VolumePainter::level_parts_for(const ViewState& view, RayBackend rays) const {
  TextureParts parts = parts_for(view, rays);
  parts.all = parts.all && !(weakened_shows_ && sampled_by_gl(view, rays));
  return parts;
}

TextureParts VolumePainter::expected_parts() const {
  return completed_by_caller_ ? expected_ : TextureParts{};
}

hal::Result<> VolumePainter::complete(const pipeline::Volume& volume, const ViewState& view,
                                      const DrawQuality& quality) {
  completed_by_caller_ = true;
  expected_ = level_parts_for(view, backend(quality));
  if (empty())
    return {};
  if (!texture_.holds(expected_))
    HAL_CHECK(texture_.renew(volume, {}, expected_));
  if (sampled_by_gl(view, backend(quality)))
    HAL_CHECK(drawn_texture());
  return needs_flow_texture(view, backend(quality))
             ? bring_flow_texture(volume, parts_for(view, backend(quality)))
             : hal::Result<>{};
}

hal::Result<const VolumeTexture*> VolumePainter::drawn_texture() {
  if (!weakened_shows_)
    return &texture_;
  if (weakened_uploads_ != uploads_) {
    const bool renewed = weakened_uploads_ + 1 == uploads_ && !changed_.empty();
    HAL_CHECK(renewed ? weakened_texture_.renew(weakened_, changed_)
                      : weakened_texture_.upload(weakened_));
    weakened_uploads_ = uploads_;
  }
  return &weakened_texture_;
}

void VolumePainter::update_transfer(const ViewState& of) {
  ViewState view = stretched(of);
  if (draws_flow(of))
    view.opacity *= tissue_beside_flow;
  const TransferSource source{view.window_offset_db, view.window_size_db,
                              view.opacity,          view.transfer,
                              view.colour_map,       depth_colours(view).value_or(DepthColours{})};
  if (transfer_source_ != source) {
    make_transfer_table(view, transfers_, *transfer_);
    if (transfer_->depths)
      transfer_->depths = depths_;
    transfer_texture_.update(*transfer_);
    transfer_source_ = source;
  }
  if (caster_)
    caster_->set_transfer(*transfer_);
}

void VolumePainter::expect(const ViewState& view) {
  expected_.b_scan = view.b_scan;
  expected_.a_scan = view.a_scan;
  see_through_db_ = view.see_through_db;
  light_wanted_ = view.technique == Technique::shaded;
  flow_wanted_ = shows_flow(view) && !flow_refusal_;
  if (view.technique == Technique::surface)
    static_cast<void>(techniques_.get(view.technique)); // that it could not be made, update() says
}

const LightVolume* VolumePainter::light_for(const ViewState& of) {
  if (of.technique != Technique::shaded || !light_shows_)
    return nullptr;
  light_.prepare(window_ramp(stretched(of)));
  return &light_;
}

RayBackend VolumePainter::backend(const DrawQuality& quality) const {
  const RayBackend wanted =
      quality.rays.value_or(software_ ? RayBackend::processor : RayBackend::shader);
  return caster_shows_ ? wanted : RayBackend::shader;
}

hal::Result<> VolumePainter::cast_rays(EyePictures& pictures, const VolumeScene& scene,
                                       const DrawQuality& quality, const Rect& rect) {
  if (!pictures.by_processor) {
    HAL_TRY(auto made, RayCastPicture::create());
    pictures.by_processor.emplace(std::move(made));
  }
  return pictures.by_processor->update(*caster_, scene, *ray_mode(scene.view.technique), quality,
                                       rect);
}

hal::Result<> VolumePainter::show_vessels(const PlacedVessels& vessels, const hal::Clock& clock) {
  if (!vessels_) {
    HAL_TRY(auto made, VesselOverlay::create(threads_, clock));
    vessels_.emplace(std::move(made));
  }
  vessels_->show(vessels);
  return {};
}

hal::Result<std::optional<DepthMask>>
VolumePainter::update_vessels(StereoEye eye, const VolumeScene& scene, const DrawQuality& quality,
                              const Rect& rect, MaskReader target) {
  if (!vessels_)
    return std::nullopt;
  return vessels_->update({.eye = eye,
                           .view = scene.view,
                           .camera = scene.camera,
                           .geometry = texture_.geometry(),
                           .width = picture_pixels(quality, rect.width),
                           .height = picture_pixels(quality, rect.height),
                           .detail_px = quality.vessel_detail_px,
                           .occluded = quality.vessels_occluded,
                           .target = target});
}

hal::Result<> VolumePainter::draw_by_gl(EyePictures& pictures, const VolumeScene& scene,
                                        const DrawQuality& quality, const Rect& rect) {
  if (scene.vessels == nullptr || scene.vessels->opacity >= 1)
    return pictures.by_gl.update(techniques_, scene, quality, rect);
  if (!pictures.alone_by_gl) {
    HAL_TRY(auto made, VolumePicture::create());
    pictures.alone_by_gl.emplace(std::move(made));
  }
  VolumeScene alone = scene;
  alone.vessels = nullptr;
  HAL_CHECK(pictures.alone_by_gl->update(techniques_, alone, quality, rect));
  return pictures.by_gl.update(techniques_, scene, quality, rect, &*pictures.alone_by_gl);
}

hal::Result<> VolumePainter::update(StereoEye eye, const ViewState& view, const Camera& camera,
                                    const DrawQuality& quality, const Rect& rect) {
  HAL_TRY(const auto pictures, pictures_of(eye));
  if (quality.rays == RayBackend::processor)
    want_processor();
  const RayBackend rays = backend(quality);
  const bool processor = cast_by_processor(view, rays);
  if (draws_flow(view))
    if (auto made = make_flow_programs(view.technique, !processor); !made)
      refuse_flow(std::move(made.error()));
  update_transfer(view);
  expect(view);
  if (!texture_.holds(level_parts_for(view, rays)) ||
      (needs_flow_texture(view, rays) &&
       (flow_uploads_ != uploads_ || !flow_texture_.holds(parts_for(view, rays)))))
    return hal::fail(hal::ErrorCode::invalid_argument,
                     "volume display: found parts of a volume, expected complete() for this view");
  const VolumeTexture* drawn = &texture_; // the processor's rays need only its shape
  const bool surface = view.technique == Technique::surface;
  if (sampled_by_gl(view, rays)) {
    HAL_TRY(drawn, drawn_texture());
  }
  VolumeScene scene{
      *drawn,      transfer_texture_, camera, view, step_mm(quality, texture_.geometry()),
      &occupancy_, uploads_};
  scene.cut_away = cut_away(view, camera, texture_.geometry());
  scene.light = light_for(view);
  scene.changed = changed_;
  scene.team = team_.get();
  FlowScene flow = flow_scene(view.opacity);
  scene.flow = draws_flow(view) ? &flow : nullptr;
  std::optional<CutFace>& cut_face = scene.flow != nullptr ? flow_cut_face_ : cut_face_;
  if (!scene.cut_away.nothing() && !cut_face) {
    HAL_TRY(auto made, CutFace::create(scene.flow != nullptr ? WithFlow::yes : WithFlow::no));
    cut_face.emplace(std::move(made));
  }
  // A cut's face is drawn by composite(), of what is there then.
  pictures->all_changed = processor != pictures->processor_drew || !scene.cut_away.nothing() ||
                          !pictures->cut_away.nothing();
  pictures->camera = camera;
  pictures->cut_away = scene.cut_away;
  pictures->flow = scene.flow != nullptr;
  if (surface) {
    HAL_CHECK(techniques_.get(view.technique));
    scene.mesh = techniques_.surface()->prepare(view);
    if (scene.flow != nullptr && !match_flow(flow))
      scene.flow = nullptr;
  }
  pictures->processor_drew = processor;
  const auto vessels =
      update_vessels(eye, scene, quality, rect, processor ? MaskReader::processor : MaskReader::gl);
  if (!vessels)
    return tl::make_unexpected(vessels.error());
  scene.vessels = *vessels ? &**vessels : nullptr;
  const std::uint64_t gl_drawings = pictures->by_gl.drawings();
  HAL_CHECK(processor ? cast_rays(*pictures, scene, quality, rect)
                      : draw_by_gl(*pictures, scene, quality, rect));
  pictures->all_changed = pictures->all_changed || pictures->by_gl.drawings() != gl_drawings;
  return {};
}

void VolumePainter::add_changed(StereoEye eye, const Rect& rect, Damage& damage) const {
  const auto& pictures = pictures_[index_of(eye)];
  if (!pictures || pictures->all_changed)
    damage.add(rect);
  else if (pictures->processor_drew)
    pictures->by_processor->add_changed(rect, damage);
}

bool VolumePainter::wants_volume(const ViewState& view) const {
  return !empty() && ((view.technique == Technique::surface && !surface_shows_) ||
                      (view.technique == Technique::shaded && !light_shows_) ||
                      (shows_flow(view) && has_flow_ && !flow_shows_ && !flow_refusal_) ||
                      view.see_through_db != shown_see_through_db_);
}

bool VolumePainter::has_newer(const ViewState& view) const {
  return view.technique == Technique::surface && techniques_.surface() != nullptr &&
         techniques_.surface()->has_newer();
}

hal::Result<> VolumePainter::finish(const pipeline::Volume& volume, const ViewState& view,
                                    const DrawQuality& quality) {
  const bool caster_missing = quality.rays == RayBackend::processor && !caster_wanted_;
  if (caster_missing)
    make_caster();
  expect(view);
  if ((caster_missing && !empty()) || wants_volume(view))
    HAL_CHECK(show(volume));
  if (view.technique == Technique::surface) {
    HAL_CHECK(techniques_.get(view.technique));
    techniques_.surface()->finish(view);
  }
  return {};
}

std::uint64_t VolumePainter::drawings() const {
  std::uint64_t count = 0;
  for (const auto& pictures : pictures_)
    if (pictures)
      count += pictures->by_gl.drawings() +
               (pictures->by_processor ? pictures->by_processor->drawings() : 0);
  return count;
}

void VolumePainter::composite(StereoEye eye, const Rect& rect, int target_height) const {
  const auto& pictures = pictures_[index_of(eye)];
  if (!pictures)
    return;
  if (pictures->processor_drew)
    pictures->by_processor->composite(rect, target_height);
  else
    pictures->by_gl.composite(rect, target_height);
  if (pictures->cut_away.nothing())
    return;
  const FlowScene flow = flow_scene(0); // a face is opaque anyway
  const CutFace& face = pictures->flow ? *flow_cut_face_ : *cut_face_;
  face.composite(texture_, transfer_texture_, pictures->flow ? &flow : nullptr, pictures->camera,
                 pictures->cut_away, rect, target_height);
}

} // namespace octascope::ui
