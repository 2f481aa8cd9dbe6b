// Golden pictures of every layout, in and out of order, and of stereo.
#include "tests/ui/support/block_typeface.h"
#include "tests/ui/support/golden.h"
#include "tests/ui/support/renderer_stage.h"
#include "tests/ui/support/vessels/vessel_along.h"

namespace octascope::tests {
namespace {

using namespace ui;

class GoldenLayout : public RendererTest {
protected:
  static Status troubled() {
    Status status = live_status();
    status.freshness = {Liveness::stale, std::chrono::milliseconds{1250}, {}};
    status.missing_b_scans = 3;
    status.saturated_lines = 41;
    status.losses = {379, 3, 1};
    status.devices[0].state = hal::DeviceState::failed;
    status.reduced_quality = 0.67F;
    status.notice = "Camera lost: looking for it again";
    return status;
  }
  static ViewState window_turned(LayoutKind layout, const Status& status) {
    ViewState view;
    view.layout = layout;
    view.b_scan = 20;
    view.echo.action = Action::window_size;
    view.echo.until = status.now + std::chrono::seconds{1};
    return view;
  }

  // A scope_width of 0: there is no microscope.
  pipeline::Image draw(const ViewState& view, const Status& status, int width, int height,
                       bool incomplete = false, int scope_width = 320) {
    open_renderer(width, height, block_typeface());
    auto volume = tissue_volume(small_geometry);
    if (incomplete)
      mark_incomplete(volume);
    EXPECT_TRUE(renderer_->show_volume(volume));
    renderer_->show_levels(level_shares(volume));
    if (scope_width > 0)
      show_scope(scope_width);
    return RendererTest::draw(view, status);
  }
};

TEST_F(GoldenLayout, b_scan) {
  const Status status = live_status();
  expect_golden(draw(window_turned(LayoutKind::b_scan, status), status, 1280, 720),
                "b_scan_1280x720");
}

TEST_F(GoldenLayout, microscope) {
  ViewState view;
  view.layout = LayoutKind::microscope;
  view.b_scan = 12;
  expect_golden(draw(view, live_status(), 1280, 720), "microscope_1280x720");
}

// In the volume, and in the four flat pictures.
TEST_F(GoldenLayout, vessels_in_each_picture) {
  open_renderer(1280, 720, block_typeface());
  ASSERT_TRUE(renderer_->show_volume(tissue_volume(small_geometry)));
  show_scope();
  constexpr float plane_mm = 20.5F * 0.075F; // of B-scan 20
  const auto tree = vessel_along({{0.3F, plane_mm, 0.75F},
                                  {1.1F, plane_mm, 0.6F},
                                  {1.9F, plane_mm + 0.1F, 0.85F},
                                  {2.7F, 2.2F, 0.7F},
                                  {1.4F, 2.8F, 0.8F},
                                  {1.2F, 0.4F, 0.7F}},
                                 0.06F);
  ASSERT_TRUE(renderer_->show_vessels(
      {tree.view(), {1.5, plane_mm, 0.8}, pipeline::RigidTransform{}}, clock_));
  ViewState view;
  view.b_scan = 20;
  view.a_scan = 60;
  for (const LayoutKind kind : {LayoutKind::b_scan, LayoutKind::microscope}) {
    view.layout = kind;
    expect_golden(RendererTest::draw(view, live_status()), kind == LayoutKind::b_scan
                                                               ? "vessels_b_scan_1280x720"
                                                               : "vessels_microscope_1280x720");
  }
}

TEST_F(GoldenLayout, colours_by_depth) {
  ViewState view;
  view.b_scan = 20;
  view.colour_map = *TransferSet{}.colour_map_named("depth");
  expect_golden(draw(view, live_status(), 1280, 720), "depth_colours_1280x720");
}

TEST_F(GoldenLayout, a_wide_microscope_picture) {
  Status status = live_status();
  status.freshness = {Liveness::frozen, std::chrono::seconds{12}, std::chrono::seconds{12}};
  ViewState view = window_turned(LayoutKind::microscope, status);
  view.frozen = true;
  expect_golden(draw(view, status, 640, 360, false, 480), "wide_microscope_640x360");
}

TEST_F(GoldenLayout, quad_in_trouble) {
  const Status status = troubled();
  ViewState view = window_turned(LayoutKind::quad, status);
  view.b_scan = 12;
  expect_golden(draw(view, status, 1280, 720, true), "quad_1280x720");
}

TEST_F(GoldenLayout, volume_in_trouble_at_1024x768) {
  const Status status = troubled();
  expect_golden(draw(window_turned(LayoutKind::volume, status), status, 1024, 768, true),
                "volume_1024x768");
}

TEST_F(GoldenLayout, a_recording_without_a_microscope) {
  ViewState view;
  view.b_scan = 20;
  expect_golden(draw(view, live_status(), 640, 360, false, 0), "recording_640x360");
}

TEST_F(GoldenLayout, side_by_side) {
  ViewState view;
  view.b_scan = 20;
  view.stereo = StereoMode::side_by_side;
  expect_golden(draw(view, live_status(), 1280, 720), "side_by_side_1280x720");
}

TEST_F(GoldenLayout, top_bottom) {
  const Status status = troubled();
  ViewState view = window_turned(LayoutKind::volume, status);
  view.stereo = StereoMode::top_bottom;
  expect_golden(draw(view, status, 640, 360, true), "top_bottom_640x360");
}

TEST_F(GoldenLayout, upright) {
  ViewState view;
  view.b_scan = 20;
  expect_golden(draw(view, live_status(), 540, 960), "volume_540x960");
}

} // namespace
} // namespace octascope::tests
