#include "ui/renderer.h"

#include <algorithm>
#include <thread>
#include <vector>

#include <GLES3/gl3.h>
#include <fmt/format.h>

#include "ui/camera.h"
#include "ui/gl/context_info.h"
#include "ui/hud/canvas_renderer.h"
#include "ui/hud/hud.h"
#include "ui/layout.h"
#include "ui/panels/b_scan_panel.h"
#include "ui/panels/en_face_panel.h"
#include "ui/panels/scope_panel.h"
#include "ui/ray_caster/ray_cast_picture.h"
#include "ui/volume/box_edges.h"
#include "ui/volume/volume_picture.h"

namespace octascope::ui {

namespace {

// What one picture was made of.
struct DrawnPicture {
  std::uint64_t volume_uploads = 0;
  std::uint64_t scope_uploads = 0;
  int width = 0;
  int height = 0;
  ViewState view;
  DrawQuality quality;
  HudText text;
  bool operator==(const DrawnPicture&) const = default;
};

// The echo shows only through the text.
ViewState without_times(ViewState view) {
  view.echo = {};
  view.frozen_since = {};
  return view;
}

// Nothing where a GPU draws, or where the ray caster knows no instruction set of this processor.
std::optional<RayCastPicture> make_ray_picture() {
  constexpr unsigned most_helpers = 15;
  if (!gl::describe_context().software)
    return std::nullopt;
  const unsigned helpers =
      std::clamp(std::thread::hardware_concurrency(), 1U, most_helpers + 1) - 1;
  auto made = RayCastPicture::create(helpers, {});
  if (!made)
    return std::nullopt;
  return std::move(*made);
}

} // namespace

struct Renderer::Parts {
  VolumeTexture volume;
  VolumePicture volume_picture;
  std::optional<RayCastPicture> ray_picture; // in its place where the processor draws
  BScanPanel b_scan_panel;
  EnFacePanel en_face_panel;
  ScopePanel scope_panel;
  CanvasRenderer canvas_renderer;
  Canvas ground{}; // under the pictures
  Canvas overlay{};
  std::optional<Fonts> fonts{};
  float fonts_unit = 0;
  std::vector<pipeline::BScanState> states{};
  std::uint64_t volume_uploads = 0;
  std::uint64_t scope_uploads = 0;
  bool scope_shown = false;
  std::optional<DrawnPicture> drawn{};

  ViewState fitted(const ViewState& view) const;
  HudScene scene(const ViewState& view) const;
  DrawnPicture picture_of(const ViewState& view, const Status& status, int width, int height,
                          const DrawQuality& quality) const;
  Layout layout(int width, int height) const;
  hal::Result<> prepare_fonts(float unit);
  void draw_box(Canvas& canvas, const Camera& camera, const Rect& view, bool in_front) const;
  hal::Result<> update_volume_picture(const ViewState& view, const DrawQuality& quality,
                                      const Rect& rect);
  void composite_volume_picture(const Rect& rect, int height) const;
  hal::Result<> draw(const DrawnPicture& picture);
};

hal::Result<> Renderer::Parts::update_volume_picture(const ViewState& view,
                                                     const DrawQuality& quality, const Rect& rect) {
  return ray_picture ? ray_picture->update(volume_uploads, view, RayMode::composite, quality, rect)
                     : volume_picture.update(volume, volume_uploads, view, quality, rect);
}

void Renderer::Parts::composite_volume_picture(const Rect& rect, int height) const {
  if (ray_picture)
    ray_picture->composite(rect, height);
  else
    volume_picture.composite(rect, height);
}

ViewState Renderer::Parts::fitted(const ViewState& view) const {
  ViewState fitted = view.clamped();
  if (!states.empty())
    fitted.b_scan = std::min(fitted.b_scan, static_cast<int>(states.size()) - 1);
  return fitted;
}

HudScene Renderer::Parts::scene(const ViewState& view) const {
  HudScene scene;
  scene.shown.volume = !volume.empty();
  if (scene.shown.volume) {
    scene.shown.geometry = volume.geometry();
    scene.shown.b_scan = states[static_cast<std::size_t>(view.b_scan)];
  }
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
  return {volume_uploads,
          scope_uploads,
          width,
          height,
          without_times(shown),
          quality,
          compose_hud_text(shown, status, scene(shown).shown)};
}

Layout Renderer::Parts::layout(int width, int height) const {
  PictureAspects aspects;
  if (!volume.empty()) {
    const pipeline::VolumeGeometry& g = volume.geometry();
    aspects.b_scan = g.a_mm() / g.depth_mm();
    aspects.en_face = g.a_mm() / g.b_mm();
  }
  if (scope_shown)
    aspects.scope = scope_panel.aspect();
  return lay_out(width, height, aspects);
}

hal::Result<> Renderer::Parts::prepare_fonts(float unit) {
  if (fonts && fonts_unit == unit)
    return {};
  auto made = Fonts::create(unit);
  if (!made)
    return tl::make_unexpected(made.error());
  fonts = std::move(*made);
  fonts_unit = unit;
  return {};
}

void Renderer::Parts::draw_box(Canvas& canvas, const Camera& camera, const Rect& view,
                               bool in_front) const {
  const Colour colour = in_front ? palette::box : palette::box_behind;
  const float width = std::max(1.0F, 1.5F * fonts_unit);
  const Canvas::Clip clip{canvas, view};
  for (const BoxEdge& edge : project_box(camera, box_extents_mm(volume.geometry()), view))
    if (edge.visible && edge.in_front == in_front)
      canvas.line(edge.from, edge.to, colour, width);
}

hal::Result<> Renderer::Parts::draw(const DrawnPicture& picture) {
  const ViewState& view = picture.view;
  const int height = picture.height;
  const Layout places = layout(picture.width, height);
  if (auto ok = prepare_fonts(places.unit); !ok)
    return ok;
  HudScene shown = scene(view);
  const bool has_volume = shown.shown.volume;
  Camera camera{};
  if (has_volume) {
    if (auto ok = update_volume_picture(view, picture.quality, places.view); !ok)
      return ok;
    camera =
        make_camera(view, box_extents_mm(volume.geometry()),
                    static_cast<float>(places.view.width) / static_cast<float>(places.view.height));
    shown.view_mm_per_pixel =
        static_cast<double>(2 * camera.tan_half_height * camera.depth_of(glm::vec3{0})) /
        places.view.height;
  }

  ground.begin(*fonts, picture.width, height);
  overlay.begin(*fonts, picture.width, height);
  if (has_volume && view.box_visible) {
    draw_box(ground, camera, places.view, false);
    draw_box(overlay, camera, places.view, true);
  }
  draw_hud_ground(ground, places);
  draw_hud(overlay, places, picture.text, view, shown);

  constexpr Colour back = palette::background;
  glViewport(0, 0, picture.width, height);
  glClearColor(static_cast<float>(back.r) / 255, static_cast<float>(back.g) / 255,
               static_cast<float>(back.b) / 255, 1);
  glClear(GL_COLOR_BUFFER_BIT);
  canvas_renderer.draw(ground, picture.width, height);
  if (has_volume) {
    composite_volume_picture(places.view, height);
    b_scan_panel.draw(volume, shown.shown.b_scan, view, places.b_scan.picture, height);
    en_face_panel.draw(places.en_face.picture, height);
  }
  if (scope_shown)
    scope_panel.draw(places.scope.picture, height, picture.text.scope_stale);
  canvas_renderer.draw(overlay, picture.width, height);
  return {};
}

hal::Result<std::unique_ptr<Renderer>> Renderer::create() {
  auto volume_picture = VolumePicture::create();
  if (!volume_picture)
    return tl::make_unexpected(volume_picture.error());
  auto b_scan = BScanPanel::create();
  if (!b_scan)
    return tl::make_unexpected(b_scan.error());
  auto en_face = EnFacePanel::create();
  if (!en_face)
    return tl::make_unexpected(en_face.error());
  auto scope = ScopePanel::create();
  if (!scope)
    return tl::make_unexpected(scope.error());
  auto canvas = CanvasRenderer::create();
  if (!canvas)
    return tl::make_unexpected(canvas.error());
  std::unique_ptr<Parts> parts{new Parts{{},
                                         std::move(*volume_picture),
                                         make_ray_picture(),
                                         std::move(*b_scan),
                                         std::move(*en_face),
                                         std::move(*scope),
                                         std::move(*canvas)}};
  return std::unique_ptr<Renderer>{new Renderer{std::move(parts)}};
}

Renderer::Renderer(std::unique_ptr<Parts> parts) : parts_{std::move(parts)} {}

Renderer::~Renderer() = default;

hal::Result<> Renderer::show_volume(const pipeline::Volume& volume) {
  if (auto ok = parts_->volume.upload(volume); !ok)
    return ok;
  if (parts_->ray_picture)
    if (auto ok = parts_->ray_picture->show(volume); !ok)
      return ok;
  parts_->en_face_panel.show(volume);
  parts_->states.assign(volume.b_scan_states.begin(), volume.b_scan_states.end());
  ++parts_->volume_uploads;
  return {};
}

hal::Result<> Renderer::show_scope_picture(const hal::ScopeFrame& frame,
                                           const std::optional<ScanField>& field) {
  if (auto ok = parts_->scope_panel.show(frame, field); !ok)
    return ok;
  parts_->scope_shown = true;
  ++parts_->scope_uploads;
  return {};
}

void Renderer::forget_scope_picture() {
  parts_->scope_shown = false;
  ++parts_->scope_uploads;
}

hal::Result<> Renderer::draw(const ViewState& view, const Status& status, int width, int height,
                             const DrawQuality& quality) {
  if (width < 1 || height < 1)
    return hal::fail(hal::Fault::invalid_argument,
                     fmt::format("renderer: size is {}x{}, expected at least 1x1", width, height));
  const DrawnPicture picture = parts_->picture_of(view, status, width, height, quality);
  parts_->drawn.reset();
  if (auto ok = parts_->draw(picture); !ok)
    return ok;
  parts_->drawn = picture;
  return {};
}

bool Renderer::casts_rays() const {
  return parts_->ray_picture.has_value();
}

bool Renderer::needs_redraw(const ViewState& view, const Status& status, int width, int height,
                            const DrawQuality& quality) const {
  return parts_->drawn != parts_->picture_of(view, status, width, height, quality);
}

pipeline::Image Renderer::read_back(int width, int height) const {
  pipeline::Image image{width, height, 3};
  const auto w = static_cast<std::size_t>(width);
  const auto h = static_cast<std::size_t>(height);
  std::vector<std::uint8_t> rgba(4 * w * h);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
  for (std::size_t y = 0; y < h; ++y) // GL's rows run from the bottom
    for (std::size_t x = 0; x < w; ++x)
      std::copy_n(rgba.data() + 4 * ((h - 1 - y) * w + x), 3,
                  image.pixels.data() + 3 * (y * w + x));
  return image;
}

} // namespace octascope::ui
