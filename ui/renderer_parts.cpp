#include "ui/renderer_parts.h"

#include <algorithm>

#include <GLES3/gl3.h>

#include "ui/gl/scissor.h"
#include "ui/view/action_table.h"
#include "ui/view/camera.h"

namespace octascope::ui {

namespace {

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

float aspect_of(const Rect& rect) {
  return static_cast<float>(rect.width) / static_cast<float>(rect.height);
}

// The echo shows only through the text.
ViewState without_times(ViewState view) {
  view.echo = {};
  view.frozen_since = {};
  return view;
}

} // namespace

void clear_to_background(int width, int height) {
  constexpr Colour back = palette::background;
  glViewport(0, 0, width, height);
  glClearColor(static_cast<float>(back.r) / 255, static_cast<float>(back.g) / 255,
               static_cast<float>(back.b) / 255, 1);
  glClear(GL_COLOR_BUFFER_BIT);
}

ViewState Renderer::Parts::fitted(const ViewState& view) const {
  ViewState fitted = view.clamped();
  if (!volume.empty())
    fit_indices(fitted, volume.texture().geometry());
  return fitted;
}

// Colours of depths say nothing without their scale, and some are those of vessels: grey instead.
ViewState Renderer::Parts::without_confusion(const ViewState& view, const Layout& places) const {
  const bool beside_vessels = volume.vessels() != nullptr && shows_tree(view);
  ViewState plain = view;
  if (volume.depth_colours(view) &&
      (beside_vessels || volume.draws_flow(view) || !has_room_for_depth_scale(places)))
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
    scene.shown.flow = flow_of(view);
  }
  scene.shown.vessels_left_out = flat_vessels && flat_vessels->left_out();
  scene.shown.scope = scope_shown;
  if (scope_shown) {
    scene.shown.scope_time = scope_panel.time();
    scene.scan_field = scope_panel.field();
  }
  return scene;
}

float Renderer::Parts::deepest_flow() const {
  return static_cast<float>(flow_depths.deepest_mm() / shown_geometry.depth_mm());
}

FlowShown Renderer::Parts::flow_of(const ViewState& view) const {
  FlowShown flow;
  flow.refused = has_flow && shows_flow(view) && volume.flow_refusal();
  if (!flow_shown(view))
    return flow;
  flow.shown = true;
  flow.late = volume.flow_late(view);
  flow.b_scan = flow_states[static_cast<std::size_t>(view.b_scan)];
  flow.told = static_cast<int>(std::ranges::count(flow_states, pipeline::FlowState::told));
  flow.left_out = static_cast<int>(std::ranges::count(flow_states, pipeline::FlowState::left_out));
  for (std::size_t b = 0; b < flow_states.size(); ++b)
    if (flow_states[b] == pipeline::FlowState::none && has_levels(states[b]))
      ++flow.none;
  flow.in_scope = scope_shown && scope_panel.field().has_value();
  flow.deepest_mm = flow_depths.deepest_mm();
  return flow;
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
  const bool flow = flow_shown(view);
  if (flow && !completed_by_caller)
    flow_sections.fetch(kept_flow, view.b_scan, view.a_scan);
  const auto draw_vessels = [&](VesselPanel panel, std::uint64_t version, const Rect& rect) {
    if (version != 0)
      flat_vessels->draw(panel, rect, height);
  };
  const auto draw_b_scan = [&](const Panel& panel, ScanDirection direction) {
    if (!panel.shown())
      return;
    const Rect rect = frame.place(panel.picture);
    draw_within(parts, rect, height, [&] {
      b_scan_panel.draw(volume.texture(), state_texture, direction, view, shown, rect, height,
                        flow ? &flow_sections : nullptr);
      if (direction == ScanDirection::fast)
        draw_vessels(VesselPanel::b_scan, vessels_over.b_scan, rect);
      else
        draw_vessels(VesselPanel::crossed, vessels_over.crossed, rect);
    });
  };
  draw_b_scan(places.b_scan, ScanDirection::fast);
  draw_b_scan(places.crossed, ScanDirection::slow);
  if (places.en_face.shown()) {
    const Rect rect = frame.place(places.en_face.picture);
    draw_within(parts, rect, height, [&] {
      en_face_panel.draw(state_texture, shown, rect, height,
                         flow ? std::optional{deepest_flow()} : std::nullopt);
      draw_vessels(VesselPanel::en_face, vessels_over.en_face, rect);
    });
  }
}

VesselSections::Sight Renderer::Parts::sight(const ViewState& view) const {
  return {view, volume.texture().geometry(), tissue, volume.uploads()};
}

namespace {

bool both_live(const DrawnPicture& picture) {
  return picture.text.liveness == Liveness::live && !picture.text.scope_stale;
}

} // namespace

bool Renderer::Parts::has_flow_in_scope(const DrawnPicture& picture) const {
  return flow_shown(picture.view) && !en_face_panel.flow_from_above().empty() && scope_shown &&
         scope_panel.field() && both_live(picture);
}

// What vessels are laid over the flat pictures.
hal::Result<> Renderer::Parts::prepare_flat_vessels(const DrawnPicture& picture,
                                                    const ViewState& view, const Layout& places) {
  vessels_over = {};
  if (!flat_vessels || volume.empty())
    return {};
  const pipeline::VolumeGeometry& g = volume.texture().geometry();
  const auto prepare = [&](VesselPanel panel, const PicturePlace& place,
                           std::uint64_t& version) -> hal::Result<> {
    HAL_CHECK(flat_vessels->prepare(panel, sight(view), place, places.unit));
    version = flat_vessels->version(panel);
    return {};
  };
  const auto in_panel = [&](FlatPicture of, const Panel& panel) {
    return place_in_panel(of, g, crop_of(view), panel.picture);
  };
  // Where nothing was received, nothing is registered.
  if (places.b_scan.shown() &&
      states[static_cast<std::size_t>(view.b_scan)] != pipeline::BScanState::missing)
    HAL_CHECK(prepare(VesselPanel::b_scan, in_panel(FlatPicture::b_scan, places.b_scan),
                      vessels_over.b_scan));
  if (places.crossed.shown())
    HAL_CHECK(prepare(VesselPanel::crossed, in_panel(FlatPicture::crossed, places.crossed),
                      vessels_over.crossed));
  if (places.en_face.shown())
    HAL_CHECK(prepare(VesselPanel::en_face, in_panel(FlatPicture::from_above, places.en_face),
                      vessels_over.en_face));
  // Vessels lie where the volume has them: nothing in the microscope's picture says so if that is
  // an old one.
  if (scope_shown && places.scope.shown() && scope_panel.field() && both_live(picture))
    HAL_CHECK(prepare(VesselPanel::microscope,
                      place_in_field(g, *scope_panel.field(), places.scope.picture),
                      vessels_over.scope));
  return {};
}

void Renderer::Parts::draw_scope(const DrawnPicture& picture, const Layout& places,
                                 const EyeFrame& frame, RectList parts) {
  if (!scope_shown || !places.scope.shown())
    return;
  const Rect rect = frame.place(places.scope.picture);
  draw_within(parts, rect, picture.height,
              [&] { scope_panel.draw(rect, picture.height, picture.text.scope_stale); });
  if (has_flow_in_scope(picture))
    draw_within(parts, around(*scope_panel.field(), rect), picture.height, [&] {
      field_flow->draw(en_face_panel.flow(), deepest_flow(), *scope_panel.field(), rect,
                       picture.height);
    });
  if (vessels_over.scope != 0)
    draw_within(parts, rect, picture.height,
                [&] { flat_vessels->draw(VesselPanel::microscope, rect, picture.height); });
}

// What is to be drawn anew: all of what is for two eyes, else what is different.
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
  now.flow = flow_shown(picture.view);
  now.deepest_flow = deepest_flow();
  now.flow_in_scope = has_flow_in_scope(picture) ? volume.uploads() : 0;
  now.vessels = vessels_over;
  picture_changes.compare(now, damage);
  if (!now.view.empty())
    volume.add_changed(StereoEye::centre, now.view, damage);
  const bool two_eyes = picture.view.stereo != StereoMode::off;
  if (two_eyes)
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
    clear_to_background(all.width, all.height);
  else
    draw_within(uncovered, all, all.height, [&] { clear_to_background(all.width, all.height); });
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
  HAL_CHECK(prepare_flat_vessels(picture, view, places));
  const RectList parts = find_parts(picture, places, frame, buffer);
  find_uncovered(places, frame, parts);
  if (eye != StereoEye::right) // whose half is clear, too
    clear_parts(picture, parts);
  canvas_renderer.draw(ground, frame, height, uncovered);
  draw_scope(picture, places, frame, parts);
  canvas_renderer.draw(under_volume, frame, height, parts);
  if (has_view)
    draw_within(parts, view_rect, height, [&] { volume.composite(eye, view_rect, height); });
  if (has_volume)
    draw_flat_pictures(view, places, frame, height, parts);
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

// Before they are shown: a part of them may be even where the rest cannot.
void Renderer::Parts::note(std::span<const pipeline::BScanRange> changed, int b_scans) {
  for (const pipeline::BScanRange& range : changed)
    picture_changes.note(range, b_scans);
}

namespace {

bool is_whole(const pipeline::Volume& volume) {
  return std::ranges::find(volume.b_scan_states, pipeline::BScanState::seam) ==
         volume.b_scan_states.end();
}

} // namespace

hal::Result<> Renderer::Parts::prepare_flow() {
  HAL_CHECK(b_scan_panel.prepare_flow());
  HAL_CHECK(en_face_panel.prepare_flow());
  if (!field_flow) {
    HAL_TRY(auto made, FieldFlow::create());
    field_flow.emplace(std::move(made));
  }
  return {};
}

hal::Result<> Renderer::Parts::follow_flow(const pipeline::Volume& shown,
                                           std::span<const pipeline::BScanRange> changed) {
  has_flow = shown.has_flow();
  if (!has_flow || volume.flow_refusal())
    return {};
  if (auto ready = prepare_flow(); !ready) {
    volume.refuse_flow(std::move(ready.error()));
    return {};
  }
  flow_states.assign(shown.flow_states.begin(), shown.flow_states.end());
  // Hues stay while most of it is not there, but for the first ones.
  const auto told = std::ranges::count(flow_states, pipeline::FlowState::told);
  if (flow_depths.deepest_mm() == 0 || (is_whole(shown) && 2 * told > std::ssize(flow_states)))
    flow_depths.follow(en_face_panel.flow_from_above(), shown.geometry.depth_mm());
  flow_sections.note(changed);
  if (!completed_by_caller) {
    kept_flow.geometry = shown.geometry;
    kept_flow.flow = shown.flow;
  }
  return {};
}

// The flat pictures keep their cut, and the colours of depths theirs, until a volume is whole.
hal::Result<> Renderer::Parts::follow(const pipeline::Volume& shown,
                                      std::span<const pipeline::BScanRange> changed) {
  tissue.update(volume.occupancy(), shown.b_scan_states);
  if (is_whole(shown)) {
    crop.follow(tissue.extents());
    const Section depth = crop.current().depth;
    coloured_depths.follow({depth.from, depth.to});
    volume.colour_depths(coloured_depths.current());
  }
  en_face_panel.show(shown, tissue, changed, volume.team(), volume.has_flow_computed());
  picture_changes.note_projection(en_face_panel.changed_rows());
  state_texture.upload(shown);
  states.assign(shown.b_scan_states.begin(), shown.b_scan_states.end());
  return follow_flow(shown, changed);
}

} // namespace octascope::ui
