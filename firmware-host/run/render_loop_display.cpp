// Of the render loop: the display that it opens, loses and looks for again.
#include <chrono>
#include <utility>

#include "firmware-host/run/render_loop.h"
#include "ui/gl/context_info.h"
#include "ui/volume/volume_texture.h"

namespace octascope::firmware_host {

namespace {

// For so long a display that is there and fails is opened anew before a restart is called for.
constexpr std::chrono::seconds patience_with_display{30};

} // namespace

hal::Result<> RenderLoop::open() {
  HAL_CHECK(open_display());
  return ui::VolumeTexture::check_size(setup_.geometry);
}

hal::Result<> RenderLoop::open_display() {
  if (parts_.display.state() != hal::DeviceState::ready) // else it shows the splash
    HAL_CHECK(parts_.display.open(setup_.display));
  last_flip_ = 0;
  presented_.reset();
  auto renderer = ui::Renderer::create(setup_.transfers, parts_.threads);
  if (!renderer) {
    parts_.display.close();
    return tl::make_unexpected(renderer.error());
  }
  renderer_ = std::move(*renderer);
  software_ = ui::gl::describe_context().software;
  governor_ = ui::Governor{frame_budget()};
  return show_again();
}

// A display that came back shows what the lost one did. Nothing else brings it: of a frozen picture
// no volume is taken, and a microscope camera that is gone sends no other picture.
hal::Result<> RenderLoop::show_again() {
  if (scope_picture_ != nullptr)
    show_scope_picture();
  if (parts_.vessels != nullptr)
    HAL_CHECK(parts_.vessels->show_again(*renderer_));
  renderer_->expect(controller_.state());
  if (parts_.volumes.has_flow())
    renderer_->prepare_flow(controller_.state());
  return volume_.show_again(*renderer_);
}

// Once in the report; the display says it for as long as flow should be shown.
void RenderLoop::report_flow_refusal() {
  if (flow_refusal_reported_ || !renderer_ || !renderer_->flow_refusal())
    return;
  flow_refusal_reported_ = true;
  parts_.faults.add(pipeline::Fault::flow_not_shown, renderer_->flow_refusal()->message,
                    parts_.clock.now());
}

// Without a monitor a restart would bring none, and it would cost a frozen picture and the view:
// the loop waits for as long as that takes. A display that is there and cannot be opened may be a
// driver's state in this process: after a while that is left to a restart.
void RenderLoop::look_for_display(const hal::Error& error, hal::TimePoint now) {
  if (parts_.proof == nullptr)
    return;
  if (error.code == hal::ErrorCode::absent ||
      (display_lost_ && now - *display_lost_ <= patience_with_display))
    parts_.proof->looked_for_display();
}

void RenderLoop::lose_display(const hal::Error& error) {
  display_lost_ = parts_.clock.now();
  parts_.faults.add(pipeline::Device::display, error, parts_.clock.now());
  renderer_.reset();
  parts_.display.close();
  undisplayed_last_line_.reset();
  volume_.forget_unseen();
  undisplayed_control_.reset();
  drawn_view_.reset();
  levels_of_ = 0;
  drawn_liveness_ = ui::Liveness::waiting;
}

bool RenderLoop::display_ready() {
  // One that failed while its events were read is not drawn on: even that would talk to it.
  if (renderer_ && parts_.display.state() == hal::DeviceState::failed) {
    if (const auto flip = parts_.display.present(); !flip)
      lose_display(flip.error());
  }
  if (renderer_)
    return true;
  const hal::TimePoint now = parts_.clock.now();
  if (!retry_.due(now))
    return false;
  if (const auto opened = open_display(); !opened) {
    parts_.faults.add(pipeline::Device::display, opened.error(), now);
    look_for_display(opened.error(), now);
    retry_.failure(now);
    return false;
  }
  display_lost_.reset();
  retry_.success();
  return true;
}

} // namespace octascope::firmware_host
