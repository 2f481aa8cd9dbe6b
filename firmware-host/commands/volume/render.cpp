#include "firmware-host/commands/volume/render.h"

#include "firmware-host/commands/offscreen_gl.h"
#include "ui/renderer.h"

namespace octascope::firmware_host {

namespace {

ui::ViewState windowed(const RenderOptions& options, const pipeline::Volume& volume) {
  ui::ViewState view = options.view;
  const auto window = options.window ? options.window : ui::suggest_window(volume);
  if (window) {
    view.window_offset_db = window->offset_db;
    view.window_size_db = window->size_db;
  }
  return view;
}

// Whoever asks for the processor shall not be shown what GL draws.
hal::Result<> check_processor(const ui::Renderer& renderer, const RenderOptions& options) {
  if (options.quality.rays != ui::RayBackend::processor || renderer.casts_rays(options.quality))
    return {};
  return hal::fail(hal::ErrorCode::unsupported,
                   "the processor cannot cast this volume's rays: found one that is too large, or "
                   "a processor without a vector unit that the ray caster knows; let GL draw it "
                   "(--drawn-by gl)");
}

hal::Result<pipeline::Image> draw(const pipeline::Volume& volume, const RenderOptions& options,
                                  const hal::Clock& clock) {
  HAL_TRY(const auto renderer, ui::Renderer::create(options.transfers));
  HAL_CHECK(renderer->show_volume(volume));
  if (options.vessels)
    HAL_CHECK(renderer->show_vessels(*options.vessels, clock));
  const ui::ViewState view = windowed(options, volume);
  HAL_CHECK(renderer->prepare(volume, view, options.quality));
  HAL_CHECK(check_processor(*renderer, options));
  HAL_CHECK(renderer->draw_volume_alone(view, options.width, options.height, options.quality));
  return renderer->read_back(options.width, options.height);
}

} // namespace

hal::Result<pipeline::Image> render_volume(const pipeline::Volume& volume,
                                           const RenderOptions& options) {
  if (options.quality.rays == ui::RayBackend::processor && !casts_rays(options.view.technique))
    return hal::fail(hal::ErrorCode::invalid_argument,
                     "--drawn-by is processor for the technique {}, which GL draws; expected rays, "
                     "shaded or maximum with it",
                     to_string(options.view.technique));
  const ui::CutShape cut = options.view.cut;
  if (cut != ui::CutShape::none && options.view.b_scan >= volume.geometry.b_scans)
    return hal::fail(hal::ErrorCode::invalid_argument,
                     "--cut is {}, expected a B-scan of the volume, 0 to {}", options.view.b_scan,
                     volume.geometry.b_scans - 1);
  if (cut == ui::CutShape::corner && options.view.a_scan >= volume.geometry.a_scans)
    return hal::fail(hal::ErrorCode::invalid_argument,
                     "--cut is {},{}, expected an A-scan of the volume, 0 to {}, behind the comma",
                     options.view.b_scan, options.view.a_scan, volume.geometry.a_scans - 1);
  HAL_TRY(const auto gl, OffscreenGl::open(options.width, options.height));
  return draw(volume, options, gl->clock());
}

} // namespace octascope::firmware_host
