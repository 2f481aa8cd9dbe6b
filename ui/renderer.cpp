#include "ui/renderer.h"

#include <algorithm>
#include <vector>

#include <GLES3/gl3.h>

#include "ui/canvas/canvas_renderer.h"
#include "ui/damage/canvas_tiles.h"
#include "ui/damage/damage_history.h"
#include "ui/damage/picture_changes.h"
#include "ui/gl/framebuffer.h"
#include "ui/gl/scissor.h"
#include "ui/hud/hud.h"
#include "ui/layout/layout.h"
#include "ui/layout/stereo.h"
#include "ui/panels/b_scan_panel.h"
#include "ui/panels/en_face_panel.h"
#include "ui/panels/scope_panel.h"
#include "ui/scene/volume_painter.h"
#include "ui/vessels/sections/flat_vessels.h"
#include "ui/view/action_table.h"
#include "ui/view/camera.h"

namespace octascope::ui {

namespace {

// What one picture was made of.
struct DrawnPicture {
  std::uint64_t volume_uploads = 0;
  std::uint64_t scope_uploads = 0;
  std::uint64_t level_uploads = 0;
  std::uint64_t vessel_uploads = 0;
  int width = 0;
  int height = 0;
  ViewState view;
  DrawQuality quality;
  HudText text;
  bool operator==(const DrawnPicture&) const = default;
};

using RectList = std::span<const Rect>;

// Draws only in those parts of the picture that fills `rect`.
template <class Draw>
void draw_within(RectList parts, const Rect& rect, int target_height, const Draw& draw) {
  for (const Rect& part : parts) {
    const Rect shown = common(part, rect);
    if (shown.empty())
      continue;
    const gl::Scissor clip{shown, target_height};
    draw();
  }
}

void clear(int width, int height) {
  constexpr Colour back = palette::background;
  glViewport(0, 0, width, height);
  glClearColor(static_cast<float>(back.r) / 255, static_cast<float>(back.g) / 255,
               static_cast<float>(back.b) / 255, 1);
  glClear(GL_COLOR_BUFFER_BIT);
}

hal::Result<> check_size(int width, int height) {
  if (width >= 1 && height >= 1)
    return {};
  return hal::fail(hal::ErrorCode::invalid_argument,
                   "renderer: size is {}x{}, expected at least 1x1", width, height);
}

float aspect_of(const Rect& rect) {
  return static_cast<float>(rect.width) / static_cast<float>(rect.height);
}

// The volume all over the picture. Lines stay visible in the smallest.
Layout lay_out_alone(int width, int height) {
  Layout places;
  places.unit = std::max(0.5F, lay_out(width, height, {}).unit);
  places.view = {0, 0, width, height};
  return places;
}

// The echo shows only through the text.
ViewState without_times(ViewState view) {
  view.echo = {};
  view.frozen_since = {};
  return view;
}

} // namespace

struct Renderer::Parts {
  VolumePainter volume;
  BScanPanel b_scan_panel;
  EnFacePanel en_face_panel;
  ScopePanel scope_panel;
  CanvasRenderer canvas_renderer;
  Typeface typeface;
  std::optional<FlatVessels> flat_vessels{}; // empty until some are shown
  Canvas ground{};                           // under all pictures
  Canvas under_volume{};                     // which may be an inset
  Canvas overlay{};
  std::optional<Fonts> fonts{};
  float fonts_unit = 0;
  std::vector<pipeline::BScanState> states{};
  StateTexture state_texture{};
  pipeline::VolumeGeometry shown_geometry{};
  TissueMap tissue{};
  SteadyCrop crop{}; // of the flat pictures
  GlidingDepths coloured_depths{};
  std::optional<LevelShares> levels{};
  std::uint64_t level_uploads = 0;
  std::uint64_t scope_uploads = 0;
  std::uint64_t vessel_uploads = 0;
  hal::Duration vessel_cost{}; // of the last draw()
  bool scope_shown = false;
  std::optional<DrawnPicture> drawn{};
  bool drew_volume = false;
  CanvasTiles canvas_tiles{};
  PictureChanges picture_changes{};
  Damage damage{};
  DamageHistory history{};
  std::vector<Rect> uncovered{}; // what is to be drawn and not covered by pictures

  ViewState fitted(const ViewState& view) const;
  ViewState without_confusion(const ViewState& view, const Layout& places) const;
  HudScene scene(const ViewState& view) const;
  DrawnPicture picture_of(const ViewState& view, const Status& status, int width, int height,
                          const DrawQuality& quality) const;
  void note(std::span<const pipeline::BScanRange> changed, int b_scans);
  void follow(const pipeline::Volume& shown);
  hal::Duration spent_on_vessels() const;
  Crop crop_of(const ViewState& view) const {
    return view.zoom_to_tissue ? crop.current() : Crop{};
  }
  Layout layout(const DrawnPicture& picture) const;
  hal::Result<> prepare_fonts(float unit);
  void fill_canvases(const DrawnPicture& picture, const Layout& places, const HudScene& shown);
  hal::Result<> draw(const DrawnPicture& picture, const hal::BackBuffer& buffer);
  RectList find_parts(const DrawnPicture& picture, const Layout& places, const EyeFrame& frame,
                      const hal::BackBuffer& buffer);
  void find_uncovered(const Layout& places, const EyeFrame& frame, RectList parts);
  void clear_parts(const DrawnPicture& picture, RectList parts) const;
  hal::Result<> draw_eye(const DrawnPicture& picture, const Layout& places, StereoEye eye,
                         const hal::BackBuffer& buffer);
  void draw_flat_pictures(const ViewState& view, const Layout& places, const EyeFrame& frame,
                          int height, RectList parts);
  VesselSections::Sight sight(const ViewState& view) const;
  hal::Result<> draw_flat_vessels(const ViewState& view, const Layout& places,
                                  const EyeFrame& frame, int height);
  hal::Result<> draw_scope(const DrawnPicture& picture, const Layout& places, const EyeFrame& frame,
                           RectList parts);
  hal::Result<> draw_eye_alone(const ViewState& view, const Layout& places,
                               const DrawQuality& quality, StereoEye eye);
};

ViewState Renderer::Parts::fitted(const ViewState& view) const {
  ViewState fitted = view.clamped();
  if (!volume.empty())
    fit_indices(fitted, volume.texture().geometry());
  return fitted;
}

// Colours of depths say nothing without their scale, and some are those of vessels: grey instead.
ViewState Renderer::Parts::without_confusion(const ViewState& view, const Layout& places) const {
  const bool beside_vessels = volume.vessels() != nullptr && view.vessels_visible;
  ViewState plain = view;
  if (volume.depth_colours(view) && (beside_vessels || !has_room_for_depth_scale(places)))
    plain.colour_map = 0;
  return plain;
}

HudScene Renderer::Parts::scene(const ViewState& view) const {
  HudScene scene;
  scene.shown.volume = !volume.empty();
  if (scene.shown.volume) {
    scene.shown.geometry = volume.texture().geometry();
    scene.shown.b_scan = states[static_cast<std::size_t>(view.b_scan)];
    scene.extents_mm = box_extents_mm(volume.texture().geometry());
    scene.states = states;
    scene.crop = crop_of(view);
    scene.depth_colours = volume.depth_colours(view);
    scene.levels = levels ? &*levels : nullptr;
  }
  scene.shown.vessels_left_out = flat_vessels && flat_vessels->left_out();
  scene.shown.scope = scope_shown;
  if (scope_shown) {
    scene.shown.scope_time = scope_panel.time();
    scene.scan_field = scope_panel.field();
  }
  return scene;
}

DrawnPicture Renderer::Parts::picture_of(const ViewState& view, const Status& status, int width,
                                         int height, const DrawQuality& quality) const {
  const ViewState shown = fitted(view);
  return {volume.uploads(),     scope_uploads, level_uploads,
          vessel_uploads,       width,         height,
          without_times(shown), quality,       compose_hud_text(shown, status, scene(shown).shown)};
}

hal::Duration Renderer::Parts::spent_on_vessels() const {
  return volume.vessels() != nullptr ? volume.vessels()->spent() : hal::Duration{};
}

Layout Renderer::Parts::layout(const DrawnPicture& picture) const {
  PictureAspects aspects;
  if (!volume.empty()) {
    const pipeline::VolumeGeometry& g = volume.texture().geometry();
    const Crop shown = crop_of(picture.view);
    aspects.b_scan = shown.a_mm(g) / shown.depth_mm(g);
    aspects.crossed = shown.b_mm(g) / shown.depth_mm(g);
    aspects.en_face = shown.a_mm(g) / shown.b_mm(g);
  }
  aspects.has_scope = scope_shown;
  if (scope_shown)
    aspects.scope = scope_panel.aspect();
  return lay_out(picture.width, picture.height, aspects, picture.view.layout,
                 {.figures = picture.text.figures_shown,
                  .legend = picture.text.legend != nullptr,
                  .timing = picture.text.timing != nullptr});
}

hal::Result<> Renderer::Parts::prepare_fonts(float unit) {
  if (fonts && fonts_unit == unit)
    return {};
  HAL_TRY(auto made, Fonts::create(unit, typeface));
  fonts = std::move(made);
  fonts_unit = unit;
  history.forget(); // glyphs of another atlas
  return {};
}

void Renderer::Parts::fill_canvases(const DrawnPicture& picture, const Layout& places,
                                    const HudScene& shown) {
  for (Canvas* canvas : {&ground, &under_volume, &overlay})
    canvas->begin(*fonts, picture.width, picture.height);
  draw_hud_ground(ground, places);
  draw_view_ground(under_volume, places);
  draw_box_marks(under_volume, places, picture.view, shown, false);
  draw_box_marks(overlay, places, picture.view, shown, true);
  draw_hud(overlay, places, picture.text, picture.view, shown);
}

void Renderer::Parts::draw_flat_pictures(const ViewState& view, const Layout& places,
                                         const EyeFrame& frame, int height, RectList parts) {
  const Crop shown = crop_of(view);
  const auto draw_b_scan = [&](const Panel& panel, ScanDirection direction) {
    if (!panel.shown())
      return;
    const Rect rect = frame.place(panel.picture);
    draw_within(parts, rect, height, [&] {
      b_scan_panel.draw(volume.texture(), state_texture, direction, view, shown, rect, height);
    });
  };
  draw_b_scan(places.b_scan, ScanDirection::fast);
  draw_b_scan(places.crossed, ScanDirection::slow);
  if (places.en_face.shown()) {
    const Rect rect = frame.place(places.en_face.picture);
    draw_within(parts, rect, height,
                [&] { en_face_panel.draw(state_texture, shown, rect, height); });
  }
}

VesselSections::Sight Renderer::Parts::sight(const ViewState& view) const {
  return {view, volume.texture().geometry(), tissue, volume.uploads()};
}

hal::Result<> Renderer::Parts::draw_flat_vessels(const ViewState& view, const Layout& places,
                                                 const EyeFrame& frame, int height) {
  if (!flat_vessels)
    return {};
  const auto draw = [&](VesselPanel panel, FlatPicture picture, const Rect& rect) {
    return flat_vessels->draw(
        panel, sight(view),
        place_in_panel(picture, volume.texture().geometry(), crop_of(view), rect), places.unit,
        frame.place(rect), height);
  };
  // Where nothing was received, nothing is registered.
  const bool received =
      states[static_cast<std::size_t>(view.b_scan)] != pipeline::BScanState::missing;
  if (places.b_scan.shown() && received)
    HAL_CHECK(draw(VesselPanel::b_scan, FlatPicture::b_scan, places.b_scan.picture));
  if (places.crossed.shown())
    HAL_CHECK(draw(VesselPanel::crossed, FlatPicture::crossed, places.crossed.picture));
  if (places.en_face.shown())
    HAL_CHECK(draw(VesselPanel::en_face, FlatPicture::from_above, places.en_face.picture));
  return {};
}

// The vessels lie where the volume has them: nothing in this picture says so if that is an old one.
hal::Result<> Renderer::Parts::draw_scope(const DrawnPicture& picture, const Layout& places,
                                          const EyeFrame& frame, RectList parts) {
  if (!scope_shown || !places.scope.shown())
    return {};
  const Rect& place = places.scope.picture;
  const Rect rect = frame.place(place);
  draw_within(parts, rect, picture.height,
              [&] { scope_panel.draw(rect, picture.height, picture.text.scope_stale); });
  const bool both_live = picture.text.liveness == Liveness::live && !picture.text.scope_stale;
  if (!flat_vessels || volume.empty() || !scope_panel.field() || !both_live)
    return {};
  return flat_vessels->draw(
      VesselPanel::microscope, sight(picture.view),
      place_in_field(volume.texture().geometry(), *scope_panel.field(), place), places.unit, rect,
      picture.height);
}

// What is to be drawn anew: all of what has vessels or is for two eyes, else what is different.
RectList Renderer::Parts::find_parts(const DrawnPicture& picture, const Layout& places,
                                     const EyeFrame& frame, const hal::BackBuffer& buffer) {
  damage.begin(picture.width, picture.height);
  canvas_tiles.begin(picture.width, picture.height);
  for (const Canvas* canvas : {&ground, &under_volume, &overlay})
    canvas_tiles.add(*canvas);
  canvas_tiles.compare(damage);
  const bool has_volume = !volume.empty();
  const auto place = [&](const Rect& rect, bool shown) {
    return shown && !rect.empty() ? frame.place(rect) : Rect{};
  };
  PictureSources now{.view = place(places.view, has_volume),
                     .b_scan = place(places.b_scan.picture, has_volume),
                     .crossed = place(places.crossed.picture, has_volume),
                     .en_face = place(places.en_face.picture, has_volume),
                     .scope = place(places.scope.picture, scope_shown)};
  now.geometry = shown_geometry;
  now.crop = crop_of(picture.view);
  now.window_offset_db = picture.view.window_offset_db;
  now.window_size_db = picture.view.window_size_db;
  now.b_scan_index = picture.view.b_scan;
  now.a_scan_index = picture.view.a_scan;
  now.scope_uploads = scope_uploads;
  now.scope_stale = picture.text.scope_stale;
  picture_changes.compare(now, damage);
  if (!now.view.empty())
    volume.add_changed(StereoEye::centre, now.view, damage);
  const bool two_eyes = picture.view.stereo != StereoMode::off;
  if (two_eyes || flat_vessels)
    damage.add_everything();
  history.add(buffer, damage);
  if (two_eyes) // what was compared was one of them
    history.forget();
  return damage.rects();
}

// Where pictures will lie that hide all that is under them, nothing need be drawn. (For two eyes, a
// canvas is drawn as a whole.)
void Renderer::Parts::find_uncovered(const Layout& places, const EyeFrame& frame, RectList parts) {
  uncovered.assign(parts.begin(), parts.end());
  const auto cover = [&](const Panel& panel, bool shown) {
    if (shown && panel.shown() && frame.width == frame.target.width &&
        frame.height == frame.target.height)
      cut_out(uncovered, frame.place(panel.picture));
  };
  cover(places.b_scan, !volume.empty());
  cover(places.crossed, !volume.empty());
  cover(places.en_face, !volume.empty());
  cover(places.scope, scope_shown);
}

// With all of a picture, what lies around it in a larger framebuffer.
void Renderer::Parts::clear_parts(const DrawnPicture& picture, RectList parts) const {
  const Rect all{0, 0, picture.width, picture.height};
  if (std::ranges::find(parts, all) != parts.end())
    clear(all.width, all.height);
  else
    draw_within(uncovered, all, all.height, [&] { clear(all.width, all.height); });
}

hal::Result<> Renderer::Parts::draw_eye(const DrawnPicture& picture, const Layout& places,
                                        StereoEye eye, const hal::BackBuffer& buffer) {
  const ViewState view = without_confusion(picture.view, places);
  const int height = picture.height;
  const EyeFrame frame = eye_frame(view.stereo, eye, picture.width, height);
  HudScene shown = scene(view);
  const bool has_volume = shown.shown.volume;
  const bool has_view = has_volume && !places.view.empty();
  const Rect view_rect = frame.place(places.view);
  if (has_view) {
    shown.camera = make_camera(view, shown.extents_mm, aspect_of(places.view), eye);
    HAL_CHECK(volume.update(eye, view, shown.camera, picture.quality, view_rect));
  }
  fill_canvases(picture, places, shown);
  const RectList parts = find_parts(picture, places, frame, buffer);
  find_uncovered(places, frame, parts);
  if (eye != StereoEye::right) // whose half is clear, too
    clear_parts(picture, parts);
  canvas_renderer.draw(ground, frame, height, uncovered);
  HAL_CHECK(draw_scope(picture, places, frame, parts));
  canvas_renderer.draw(under_volume, frame, height, parts);
  if (has_view)
    draw_within(parts, view_rect, height, [&] { volume.composite(eye, view_rect, height); });
  if (has_volume) {
    draw_flat_pictures(view, places, frame, height, parts);
    HAL_CHECK(draw_flat_vessels(view, places, frame, height));
  }
  canvas_renderer.draw(overlay, frame, height, parts);
  return {};
}

hal::Result<> Renderer::Parts::draw_eye_alone(const ViewState& wanted, const Layout& places,
                                              const DrawQuality& quality, StereoEye eye) {
  const ViewState view = without_confusion(wanted, places);
  const int height = places.view.height;
  const EyeFrame frame = eye_frame(view.stereo, eye, places.view.width, height);
  const Rect rect = frame.place(places.view);
  HudScene shown = scene(view);
  shown.camera = make_camera(view, shown.extents_mm, aspect_of(places.view), eye);
  HAL_CHECK(volume.update(eye, view, shown.camera, quality, rect));
  for (Canvas* canvas : {&under_volume, &overlay}) {
    canvas->begin(*fonts, places.view.width, height);
    if (view.box_visible)
      draw_wire_frame(*canvas, places.view, shown, places.unit, canvas == &overlay);
  }
  draw_view_scale(overlay, places, shown);
  draw_depth_scale(overlay, places, shown);
  if (volume.vessels() != nullptr && volume.vessels()->shows_unregistered(view))
    overlay.shadowed_text({16 * places.unit, 12 * places.unit}, TextStyle::label, palette::warning,
                          "Vessels not registered");
  canvas_renderer.draw(under_volume, frame, height);
  volume.composite(eye, rect, height);
  canvas_renderer.draw(overlay, frame, height);
  return {};
}

hal::Result<> Renderer::Parts::draw(const DrawnPicture& picture, const hal::BackBuffer& buffer) {
  const Layout places = layout(picture);
  HAL_CHECK(prepare_fonts(places.unit));
  const std::uint64_t before = volume.drawings();
  const hal::Duration spent_before = spent_on_vessels();
  for (const StereoEye eye : eyes_of(picture.view.stereo))
    HAL_CHECK(draw_eye(picture, places, eye, buffer));
  drew_volume = volume.drawings() != before;
  vessel_cost = spent_on_vessels() - spent_before;
  return {};
}

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

// Before they are shown: a part of them may be even where the rest cannot.
void Renderer::Parts::note(std::span<const pipeline::BScanRange> changed, int b_scans) {
  for (const pipeline::BScanRange& range : changed)
    picture_changes.note(range, b_scans);
}

// The flat pictures keep their cut, and the colours of depths theirs, until a volume is whole.
void Renderer::Parts::follow(const pipeline::Volume& shown) {
  tissue.update(volume.occupancy(), shown.b_scan_states);
  if (std::ranges::find(shown.b_scan_states, pipeline::BScanState::seam) ==
      shown.b_scan_states.end()) {
    crop.follow(tissue.extents());
    const Section depth = crop.current().depth;
    coloured_depths.follow({depth.from, depth.to});
    volume.colour_depths(coloured_depths.current());
  }
  en_face_panel.show(shown, tissue);
  picture_changes.note_projection(en_face_panel.changed_rows());
  state_texture.upload(shown);
  states.assign(shown.b_scan_states.begin(), shown.b_scan_states.end());
}

hal::Result<> Renderer::show_volume(const pipeline::Volume& volume) {
  const pipeline::BScanRange all{0, volume.geometry.b_scans};
  parts_->note({&all, 1}, volume.geometry.b_scans);
  HAL_CHECK(parts_->volume.show(volume));
  if (parts_->shown_geometry != volume.geometry) {
    parts_->crop = {};
    parts_->coloured_depths = {};
  }
  parts_->shown_geometry = volume.geometry;
  parts_->follow(volume);
  return {};
}

hal::Result<> Renderer::renew_volume(const pipeline::Volume& volume,
                                     std::span<const pipeline::BScanRange> changed) {
  if (changed.empty())
    return {};
  if (parts_->shown_geometry != volume.geometry)
    return show_volume(volume);
  parts_->note(changed, volume.geometry.b_scans);
  HAL_CHECK(parts_->volume.renew(volume, changed));
  parts_->follow(volume);
  return {};
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
  parts_->flat_vessels->show(vessels);
  ++parts_->vessel_uploads;
  return parts_->volume.show_vessels(vessels, clock);
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
  clear(width, height);
  for (const StereoEye eye : eyes_of(fitted.stereo))
    HAL_CHECK(parts_->draw_eye_alone(fitted, places, quality, eye));
  return {};
}

hal::Result<> Renderer::prepare(const pipeline::Volume& volume, const ViewState& view,
                                const DrawQuality& quality) {
  return parts_->volume.finish(volume, parts_->fitted(view), quality);
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

void Renderer::expect(const ViewState& view) {
  parts_->volume.expect(view);
}

bool Renderer::wants_volume(const ViewState& view) const {
  return parts_->volume.wants_volume(view);
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
