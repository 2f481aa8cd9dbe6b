#include "ui/scene/ray_trial.h"

#include <algorithm>

#include "pipeline/volume/level_scale.h"
#include "ui/gl/framebuffer.h"
#include "ui/scene/volume_painter.h"
#include "ui/view/camera.h"

namespace octascope::ui {

namespace {

constexpr Rect rect{0, 0, 320, 180};
constexpr int steps = 128;
constexpr int rounds = 4;

// Speckle from the middle of the depth on, darker with depth, as tissue is.
pipeline::Volume made_up_tissue() {
  pipeline::Volume volume{{128, 96, 48, 14, 30, 60}};
  std::size_t i = 0;
  std::uint32_t noise = 1;
  for (std::uint8_t& level : volume.levels) {
    const std::size_t z = i++ % 128;
    noise = noise * 1664525U + 1013904223U; // the constants of Numerical Recipes
    const std::uint32_t speckle = noise >> 27U;
    level = static_cast<std::uint8_t>(z < 50 ? 70 + speckle : 150 - z / 2 + speckle);
  }
  std::ranges::fill(volume.b_scan_states, pipeline::BScanState::good);
  return volume;
}

hal::Result<hal::Duration> time_picture(VolumePainter& painter, RayBackend backend, float yaw_deg,
                                        const hal::Clock& clock) {
  ViewState view;
  view.window_offset_db = pipeline::level_db(105);
  view.window_size_db = 30;
  view.yaw_deg += yaw_deg;
  DrawQuality quality{1, steps};
  quality.rays = backend;
  const hal::TimePoint begin = clock.now();
  const float aspect = static_cast<float>(rect.width) / static_cast<float>(rect.height);
  const Camera camera = make_camera(view, box_extents_mm(painter.texture().geometry()), aspect);
  HAL_CHECK(painter.update(StereoEye::centre, view, camera, quality, rect));
  gl::finish();
  return clock.now() - begin;
}

} // namespace

hal::Result<RayTrial> try_ray_backends(const hal::Clock& clock) {
  HAL_TRY(auto painter, VolumePainter::create());
  painter.want_processor();
  HAL_CHECK(painter.show(made_up_tissue()));
  if (painter.backend({1, steps, RayBackend::processor}) != RayBackend::processor)
    return hal::fail(hal::ErrorCode::unsupported,
                     "no ray caster for this processor: GL casts rays");
  RayTrial trial;
  for (int round = 0; round < rounds; ++round) { // of each, the first one compiles
    const auto yaw_deg = static_cast<float>(10 * round);
    HAL_TRY(const auto processor, time_picture(painter, RayBackend::processor, yaw_deg, clock));
    HAL_TRY(const auto shader, time_picture(painter, RayBackend::shader, yaw_deg, clock));
    trial.processor = std::min(trial.processor, processor);
    trial.shader = std::min(trial.shader, shader);
  }
  return trial;
}

} // namespace octascope::ui
