// Golden pictures: the whole display against pictures kept in tests/golden, in a typeface of blocks
// (tests/ui/support/block_typeface.h).
#include "pipeline/volume/flow_scale.h"
#include "tests/ui/support/block_typeface.h"
#include "tests/ui/support/golden.h"
#include "tests/ui/support/renderer_stage.h"

namespace octascope::tests {
namespace {

class GoldenPicture : public RendererTest {
protected:
  pipeline::Image draw(const pipeline::Volume* volume, const ui::ViewState& view,
                       const ui::Status& status, int width, int height) {
    open_renderer(width, height, block_typeface());
    if (volume != nullptr) {
      EXPECT_TRUE(renderer_->show_volume(*volume));
    }
    show_scope();
    return RendererTest::draw(view, status);
  }
};

TEST_F(GoldenPicture, live_tissue_at_1280x720) {
  const auto volume = tissue_volume(full_geometry);
  expect_golden(draw(&volume, {}, live_status(), 1280, 720), "live_1280x720");
}

TEST_F(GoldenPicture, live_tissue_at_640x360) {
  const auto volume = tissue_volume(full_geometry);
  expect_golden(draw(&volume, {}, live_status(), 640, 360), "live_640x360");
}

TEST_F(GoldenPicture, what_flows) {
  auto volume = perfused_volume(full_geometry);
  for (int b = 20; b < 24; ++b) {
    std::ranges::fill(volume.b_scan_flow(b), pipeline::flow_untold);
    volume.flow_states[static_cast<std::size_t>(b)] = pipeline::FlowState::left_out;
  }
  expect_golden(draw(&volume, {}, live_status(), 1280, 720), "flow_1280x720");
}

TEST_F(GoldenPicture, incomplete_and_stale) {
  auto volume = tissue_volume(small_geometry);
  mark_incomplete(volume);
  ui::ViewState view;
  view.b_scan = 12;
  ui::Status status = live_status();
  status.freshness = {ui::Liveness::stale, std::chrono::milliseconds{1250}, {}};
  status.missing_b_scans = volume.missing_b_scans();
  status.saturated_lines = 41;
  status.losses = {379, 3, 1};
  status.devices[0].state = hal::DeviceState::failed;
  status.notice = "Camera lost: looking for it again";
  expect_golden(draw(&volume, view, status, 1280, 720), "stale_1280x720");
}

TEST_F(GoldenPicture, frozen_seen_from_above_while_the_window_is_turned) {
  const auto volume = tissue_volume(small_geometry);
  ui::ViewState view;
  view.yaw_deg = 0;
  view.tilt_deg = 80;
  view.b_scan = 20;
  view.frozen = true;
  ui::Status status = live_status();
  view.echo = {ui::Action::window_size, false, {}, status.now + std::chrono::seconds{1}};
  status.freshness = {ui::Liveness::frozen, std::chrono::seconds{12}, std::chrono::seconds{12}};
  expect_golden(draw(&volume, view, status, 1280, 720), "frozen_1280x720");
}

TEST_F(GoldenPicture, veiled_at_1024x768) {
  const auto volume = tissue_volume(small_geometry);
  ui::ViewState view;
  view.b_scan = 20;
  ui::Status status = live_status();
  status.simulated = false;
  status.source_description.clear();
  status.freshness = {ui::Liveness::veiled, std::chrono::seconds{75}, {}};
  expect_golden(draw(&volume, view, status, 1024, 768), "veiled_1024x768");
}

TEST_F(GoldenPicture, waiting_for_the_first_volume) {
  ui::Status status = live_status();
  status.freshness = {};
  status.latency_p50_ms.reset();
  expect_golden(draw(nullptr, {}, status, 640, 360), "waiting_640x360");
}

} // namespace
} // namespace octascope::tests
