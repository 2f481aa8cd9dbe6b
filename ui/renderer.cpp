#include "ui/renderer.h"

#include <algorithm>
#include <utility>

#include "ui/gl/framebuffer.h"
#include "ui/layout/stereo.h"
#include "ui/renderer_parts.h"

namespace octascope::ui {

namespace {

hal::Result<> check_size(int width, int height) {
  if (width >= 1 && height >= 1)
    return {};
  return hal::fail(hal::ErrorCode::invalid_argument,
                   "renderer: size is {}x{}, expected at least 1x1", width, height);
}

// The volume all over the picture. Lines stay visible in the smallest.
Layout lay_out_alone(int width, int height) {
  Layout places;
  places.unit = std::max(0.5F, lay_out(width, height, {}).unit);
  places.view = {0, 0, width, height};
  return places;
}

} // namespace

hal::Result<std::unique_ptr<Renderer>> Renderer::create(const TransferSet& transfers,
                                                        const pipeline::ThreadSetup& threads,
                                                        const Typeface& typeface) {
  HAL_TRY(auto volume, VolumePainter::create(transfers, threads));
  HAL_TRY(auto b_scan, BScanPanel::create());
  HAL_TRY(auto en_face, EnFacePanel::create());
  HAL_TRY(auto scope, ScopePanel::create());
  HAL_TRY(auto canvas, CanvasRenderer::create());
  std::unique_ptr<Parts> parts{new Parts{std::move(volume), std::move(b_scan), std::move(en_face),
                                         std::move(scope), std::move(canvas), typeface}};
  parts->uncovered.reserve(512); // more pieces than a frame has
  return std::unique_ptr<Renderer>{new Renderer{std::move(parts)}};
}

Renderer::Renderer(std::unique_ptr<Parts> parts) : parts_{std::move(parts)} {}

Renderer::~Renderer() = default;

hal::Result<> Renderer::show_volume(const pipeline::Volume& volume) {
  const pipeline::BScanRange all{0, volume.geometry.b_scans};
  parts_->note({&all, 1}, volume.geometry.b_scans);
  HAL_CHECK(parts_->volume.show(volume));
  if (parts_->shown_geometry != volume.geometry) {
    parts_->crop = {};
    parts_->coloured_depths = {};
    parts_->flow_depths = {};
  }
  parts_->shown_geometry = volume.geometry;
  return parts_->follow(volume, {});
}

hal::Result<> Renderer::renew_volume(const pipeline::Volume& volume,
                                     std::span<const pipeline::BScanRange> changed) {
  if (changed.empty())
    return {};
  if (parts_->shown_geometry != volume.geometry)
    return show_volume(volume);
  parts_->note(changed, volume.geometry.b_scans);
  HAL_CHECK(parts_->volume.renew(volume, changed));
  return parts_->follow(volume, changed);
}

void Renderer::bring_ahead(const pipeline::Volume& coming, std::uint64_t number, int finished,
                           const pipeline::Volume& shown) {
  parts_->volume.bring_ahead(coming, number, finished, shown);
  if (parts_->volume.has_flow_computed() && coming.has_flow())
    parts_->en_face_panel.bring_ahead(coming, number, finished);
}

hal::Result<> Renderer::show_scope_picture(const hal::ScopeFrame& frame,
                                           const std::optional<ScanField>& field) {
  HAL_CHECK(parts_->scope_panel.show(frame, field));
  parts_->scope_shown = true;
  ++parts_->scope_uploads;
  return {};
}

void Renderer::show_levels(const LevelShares& shares) {
  parts_->levels = shares;
  ++parts_->level_uploads;
}

hal::Result<> Renderer::show_vessels(const PlacedVessels& vessels, const hal::Clock& clock) {
  if (!parts_->flat_vessels) {
    HAL_TRY(auto made, FlatVessels::create());
    parts_->flat_vessels.emplace(std::move(made));
  }
  HAL_CHECK(parts_->volume.show_vessels(vessels, clock));
  parts_->flat_vessels->show(vessels);
  ++parts_->vessel_uploads;
  return {};
}

Renderer::VesselReport Renderer::vessel_report() const {
  const VesselOverlay* vessels = parts_->volume.vessels();
  return vessels != nullptr ? VesselReport{vessels->account(), parts_->vessel_cost}
                            : VesselReport{};
}

void Renderer::forget_scope_picture() {
  parts_->scope_shown = false;
  ++parts_->scope_uploads;
}

hal::Result<> Renderer::draw(const ViewState& view, const Status& status, int width, int height,
                             const DrawQuality& quality, const hal::BackBuffer& buffer) {
  HAL_CHECK(check_size(width, height));
  const DrawnPicture picture = parts_->picture_of(view, status, width, height, quality);
  parts_->drawn.reset();
  const auto drawn = parts_->draw(picture, buffer);
  if (!drawn) {
    parts_->history.forget();
    return drawn;
  }
  parts_->drawn = picture;
  return {};
}

hal::Result<> Renderer::draw_volume_alone(const ViewState& view, int width, int height,
                                          const DrawQuality& quality) {
  HAL_CHECK(check_size(width, height));
  if (parts_->volume.empty())
    return hal::fail(hal::ErrorCode::invalid_argument,
                     "renderer: found no volume to draw alone, expected show_volume() before");
  const ViewState fitted = parts_->fitted(view);
  const Layout places = lay_out_alone(width, height);
  parts_->drawn.reset(); // what draw() made is not what stands there now
  parts_->history.forget();
  HAL_CHECK(parts_->prepare_fonts(places.unit));
  clear_to_background(width, height);
  for (const StereoEye eye : eyes_of(fitted.stereo))
    HAL_CHECK(parts_->draw_eye_alone(fitted, places, quality, eye));
  return {};
}

hal::Result<> Renderer::prepare(const pipeline::Volume& volume, const ViewState& view,
                                const DrawQuality& quality) {
  const ViewState fitted = parts_->fitted(view);
  parts_->volume.expect(fitted);
  if (parts_->volume.wants_volume(fitted))
    HAL_CHECK(show_volume(volume)); // in the flat pictures, too
  return parts_->volume.finish(volume, fitted, quality);
}

bool Renderer::drew_volume() const {
  return parts_->drew_volume;
}

void Renderer::finish() const {
  gl::finish();
}

bool Renderer::casts_rays(const DrawQuality& quality) const {
  return parts_->volume.backend(quality) == RayBackend::processor;
}

void Renderer::prepare_flow(const ViewState& view) {
  if (auto ready = parts_->prepare_flow(); !ready)
    parts_->volume.refuse_flow(std::move(ready.error()));
  else
    static_cast<void>(parts_->volume.prepare_flow(view.technique));
}

const std::optional<hal::Error>& Renderer::flow_refusal() const {
  return parts_->volume.flow_refusal();
}

void Renderer::expect(const ViewState& view) {
  parts_->volume.expect(view);
}

hal::Result<> Renderer::complete(const pipeline::Volume& volume, const ViewState& view,
                                 const DrawQuality& quality) {
  const ViewState fitted = parts_->fitted(view);
  parts_->volume.expect(fitted);
  if (parts_->volume.wants_volume(fitted))
    HAL_CHECK(show_volume(volume));
  parts_->completed_by_caller = true;
  if (parts_->flow_shown(fitted))
    parts_->flow_sections.fetch(volume, fitted.b_scan, fitted.a_scan);
  return parts_->volume.complete(volume, fitted, quality);
}

bool Renderer::needs_redraw(const ViewState& view, const Status& status, int width, int height,
                            const DrawQuality& quality) const {
  return parts_->volume.has_newer(view) ||
         parts_->drawn != parts_->picture_of(view, status, width, height, quality);
}

pipeline::Image Renderer::read_back(int width, int height) const {
  return gl::read_framebuffer(width, height);
}

} // namespace octascope::ui
