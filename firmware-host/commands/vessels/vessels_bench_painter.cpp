#include "firmware-host/commands/vessels/vessels_bench_painter.h"

#include "ui/gl/framebuffer.h"

namespace octascope::firmware_host {

ui::Camera VesselsBenchPainter::camera(const ui::VesselView& view) const {
  return ui::make_vessel_camera(view, bounds_, width_, height_);
}

hal::Result<ui::SegmentCounts>
VesselsBenchPainter::draw(ui::VesselMethod& method, const ui::VesselView& view, bool occluded) {
  return draw(method, view, camera(view), occluded);
}

hal::Result<ui::SegmentCounts> VesselsBenchPainter::draw(ui::VesselMethod& method,
                                                         const ui::VesselView& view,
                                                         const ui::Camera& seen, bool occluded) {
  ui::VesselScene scene{tree_, seen, glm::mat4{1}, {}, width_, height_};
  scene.look = ui::with_cue({}, view, bounds_, width_, height_);
  scene.look.occluded = occluded;
  auto account = picture_.draw(method, scene);
  ui::gl::finish();
  return account;
}

hal::Result<pipeline::Image>
VesselsBenchPainter::picture(ui::VesselMethod& method, const ui::VesselView& view, bool occluded) {
  HAL_CHECK(draw(method, view, occluded));
  return read();
}

hal::Result<pipeline::Image> VesselsBenchPainter::picture_beside(ui::VesselMethod& method,
                                                                 const ui::VesselView& view,
                                                                 float right_px, float up_px) {
  HAL_CHECK(draw(method, view, ui::turned(camera(view), right_px, up_px, height_), false));
  return read();
}

} // namespace octascope::firmware_host
