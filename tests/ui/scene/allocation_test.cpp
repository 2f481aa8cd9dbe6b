// Drawing allocates nothing of ours once it runs. Counts operator new, which the C code of the
// driver does not use.
#include "pipeline/vessels/clusters/cluster_builder.h"
#include "tests/support/allocation_counter.h"
#include "tests/support/vessels/vessel_trees.h"
#include "tests/ui/support/gl_test.h"
#include "tests/ui/support/scene.h"
#include "tests/ui/support/synthetic_volume.h"
#include "ui/renderer.h"

namespace octascope::tests {
namespace {

class Allocation : public GlTest {};

TEST_F(Allocation, a_running_display_makes_none) {
  auto renderer = ui::Renderer::create();
  ASSERT_TRUE(renderer) << renderer.error().message;
  const auto volume = tissue_volume(small_geometry);
  const ScopePicture scope{64, 48};
  ui::Status status = live_status();
  status.notice = "A notice that is longer than any small string";
  ui::ViewState view;
  const auto one_frame = [&](int i) {
    view.yaw_deg = static_cast<float>(7 * i);
    view.b_scan = i % 40;
    view.echo = {ui::Action::tilt, i % 2 == 0, {}, status.now + std::chrono::seconds{1}};
    view.legend_visible = true;
    view.legend_of_keys = i % 2 == 0;
    status.frames_per_s = i;
    status.freshness = {
        i % 2 == 0 ? ui::Liveness::live : ui::Liveness::stale, std::chrono::seconds{i}, {}};
    EXPECT_TRUE((*renderer)->show_volume(volume));
    EXPECT_TRUE((*renderer)->show_scope_picture(scope.frame(status.now), scope.field()));
    EXPECT_TRUE((*renderer)->needs_redraw(view, status, 640, 360));
    EXPECT_TRUE((*renderer)->draw(view, status, 640, 360));
    EXPECT_TRUE(display_.present());
  };
  for (int i = 0; i < 6; ++i)
    one_frame(i);
  const std::uint64_t before = allocations_of_this_thread();
  for (int i = 6; i < 16; ++i)
    one_frame(i);
  EXPECT_EQ(allocations_of_this_thread(), before);
}

TEST_F(Allocation, vessels_in_the_volume_make_none) {
  auto renderer = ui::Renderer::create();
  ASSERT_TRUE(renderer) << renderer.error().message;
  const auto volume = tissue_volume(small_geometry);
  const auto tree = pipeline::build_clusters(chain_tree(2000, 5));
  ASSERT_TRUE((*renderer)->show_vessels({tree.view(), {}, std::nullopt}, clock_));
  ui::Status status = live_status();
  status.vessels.state = ui::VesselStatus::State::shown;
  ui::ViewState view;
  view.vessel_account = true;
  const auto one_turn = [&](int i) {
    for (const ui::Technique technique : ui::all_techniques)
      for (const ui::RayBackend rays : {ui::RayBackend::shader, ui::RayBackend::processor})
        for (const float opacity : {1.0F, 0.5F}) {
          view.technique = technique;
          view.vessel_opacity = opacity;
          view.yaw_deg = static_cast<float>(50 * i);
          EXPECT_TRUE((*renderer)->show_volume(volume));
          EXPECT_TRUE((*renderer)->draw(view, status, 320, 180, {1, 100, rays}));
          status.vessels.account = (*renderer)->vessel_report().account;
        }
    EXPECT_TRUE(display_.present());
  };
  for (int i = 0; i < 3; ++i)
    one_turn(i);
  const std::uint64_t before = allocations_of_this_thread();
  for (int i = 3; i < 6; ++i)
    one_turn(i);
  EXPECT_EQ(allocations_of_this_thread(), before);
}

TEST_F(Allocation, no_technique_makes_any_once_it_was_used) {
  auto renderer = ui::Renderer::create();
  ASSERT_TRUE(renderer) << renderer.error().message;
  const auto volume = tissue_volume(small_geometry);
  const ui::Status status = live_status();
  ui::ViewState view;
  const auto one_turn = [&](int i) {
    for (const ui::Technique technique : ui::all_techniques)
      for (const ui::RayBackend rays : {ui::RayBackend::shader, ui::RayBackend::processor}) {
        view.technique = technique;
        view.yaw_deg = static_cast<float>(50 * i); // slices along more than one axis
        view.window_offset_db = static_cast<float>(i);
        EXPECT_TRUE((*renderer)->show_volume(volume));
        EXPECT_TRUE((*renderer)->draw(view, status, 320, 180, {1, 100, rays}));
      }
    EXPECT_TRUE(display_.present());
  };
  for (int i = 0; i < 4; ++i)
    one_turn(i);
  const std::uint64_t before = allocations_of_this_thread();
  for (int i = 4; i < 8; ++i)
    one_turn(i);
  EXPECT_EQ(allocations_of_this_thread(), before);
}

// Surfaces too: a new mesh allocates in its own thread and in the driver, which copies it, but not
// here.
TEST_F(Allocation, no_layout_nor_stereo_makes_any_once_it_was_used) {
  auto renderer = ui::Renderer::create();
  ASSERT_TRUE(renderer) << renderer.error().message;
  const auto volume = tissue_volume(small_geometry);
  const ScopePicture scope{64, 48};
  const ui::Status status = live_status();
  ASSERT_TRUE((*renderer)->show_scope_picture(scope.frame(status.now), scope.field()));
  ui::ViewState view;
  const auto one_turn = [&](int i) {
    for (const ui::LayoutKind layout : {ui::LayoutKind::volume, ui::LayoutKind::b_scan,
                                        ui::LayoutKind::microscope, ui::LayoutKind::quad})
      for (const ui::StereoMode stereo :
           {ui::StereoMode::off, ui::StereoMode::side_by_side, ui::StereoMode::top_bottom})
        for (const ui::Technique technique : ui::all_techniques) {
          view.layout = layout;
          view.stereo = stereo;
          view.technique = technique;
          view.yaw_deg = static_cast<float>(50 * i);
          EXPECT_TRUE((*renderer)->show_volume(volume));
          EXPECT_TRUE((*renderer)->draw(view, status, 320, 180, {0.5F, 60, {}}));
        }
    EXPECT_TRUE(display_.present());
  };
  for (int i = 0; i < 3; ++i)
    one_turn(i);
  const std::uint64_t before = allocations_of_this_thread();
  for (int i = 3; i < 5; ++i)
    one_turn(i);
  EXPECT_EQ(allocations_of_this_thread(), before);
}

} // namespace
} // namespace octascope::tests
