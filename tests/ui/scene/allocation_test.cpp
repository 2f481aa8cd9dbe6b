// Drawing allocates nothing of ours once it runs. Counts operator new, which the C code of the
// driver does not use.
#include "pipeline/vessels/clusters/cluster_builder.h"
#include "tests/support/allocation_counter.h"
#include "tests/support/vessels/vessel_trees.h"
#include "tests/ui/support/renderer_stage.h"

namespace octascope::tests {
namespace {

class Allocation : public RendererTest {
protected:
  // Once the first frames are drawn.
  template <class Frame> void expect_none(int first, int more, const Frame& frame) {
    std::uint64_t before = 0;
    for (int i = 0; i < first + more; ++i) {
      if (i == first)
        before = allocations_of_this_thread();
      EXPECT_TRUE(renderer_->show_volume(volume_));
      frame(i);
      EXPECT_TRUE(display_.present());
    }
    EXPECT_EQ(allocations_of_this_thread(), before);
  }

  const pipeline::Volume volume_ = tissue_volume(small_geometry);
  const ScopePicture scope_{64, 48};
  ui::Status status_ = live_status();
  ui::ViewState view_;
};

TEST_F(Allocation, a_running_display_makes_none) {
  status_.notice = "A notice that is longer than any small string";
  expect_none(6, 10, [&](int i) {
    view_.yaw_deg = static_cast<float>(7 * i);
    view_.b_scan = i % 40;
    view_.echo = {ui::Action::tilt, i % 2 == 0, {}, status_.now + std::chrono::seconds{1}};
    view_.legend_visible = true;
    view_.legend_of_keys = i % 2 == 0;
    status_.frames_per_s = i;
    status_.freshness = {
        i % 2 == 0 ? ui::Liveness::live : ui::Liveness::stale, std::chrono::seconds{i}, {}};
    EXPECT_TRUE(renderer_->show_scope_picture(scope_.frame(status_.now), scope_.field()));
    EXPECT_TRUE(renderer_->needs_redraw(view_, status_, 640, 360));
    EXPECT_TRUE(renderer_->draw(view_, status_, 640, 360));
  });
}

TEST_F(Allocation, vessels_in_the_volume_make_none) {
  const auto tree = pipeline::build_clusters(chain_tree(2000, 5));
  ASSERT_TRUE(renderer_->show_vessels({tree.view(), {}, std::nullopt}, clock_));
  status_.vessels.state = ui::VesselStatus::State::shown;
  view_.vessel_account = true;
  expect_none(3, 3, [&](int i) {
    view_.yaw_deg = static_cast<float>(50 * i);
    for (const ui::Technique technique : ui::all_techniques)
      for (const ui::RayBackend rays : {ui::RayBackend::shader, ui::RayBackend::processor})
        for (const float opacity : {1.0F, 0.5F}) {
          view_.technique = technique;
          view_.vessel_opacity = opacity;
          EXPECT_TRUE(renderer_->show_volume(volume_));
          EXPECT_TRUE(renderer_->draw(view_, status_, 320, 180, {1, 100, rays}));
          status_.vessels.account = renderer_->vessel_report().account;
        }
  });
}

TEST_F(Allocation, vessels_in_the_flat_pictures_make_none) {
  const auto tree = pipeline::build_clusters(chain_tree(20000, 5));
  pipeline::RigidTransform middle;
  middle.shift_mm = {1.5, 1.5, 0.9};
  ASSERT_TRUE(renderer_->show_vessels({tree.view(), {}, middle}, clock_));
  status_.vessels.state = ui::VesselStatus::State::shown;
  status_.vessels.registered = true;
  view_.layout = ui::LayoutKind::quad;
  ASSERT_TRUE(renderer_->show_scope_picture(scope_.frame(status_.now), scope_.field()));
  expect_none(10, 10, [&](int i) {
    view_.b_scan = (9 * i + 11) % 40;
    view_.a_scan = (7 * i + 31) % 100;
    view_.vessel_nudge.shift_mm[1] = 0.1F * static_cast<float>(i);
    EXPECT_TRUE(renderer_->draw(view_, status_, 640, 360));
  });
}

TEST_F(Allocation, no_technique_makes_any_once_it_was_used) {
  expect_none(4, 4, [&](int i) {
    view_.yaw_deg = static_cast<float>(50 * i); // slices along more than one axis
    view_.window_offset_db = static_cast<float>(i);
    for (const ui::Technique technique : ui::all_techniques)
      for (const ui::RayBackend rays : {ui::RayBackend::shader, ui::RayBackend::processor}) {
        view_.technique = technique;
        EXPECT_TRUE(renderer_->show_volume(volume_));
        EXPECT_TRUE(renderer_->draw(view_, status_, 320, 180, {1, 100, rays}));
      }
  });
}

// Surfaces too: a new mesh allocates in its own thread and in the driver, which copies it, but not
// here.
TEST_F(Allocation, no_layout_nor_stereo_makes_any_once_it_was_used) {
  ASSERT_TRUE(renderer_->show_scope_picture(scope_.frame(status_.now), scope_.field()));
  expect_none(3, 2, [&](int i) {
    view_.yaw_deg = static_cast<float>(50 * i);
    for (const ui::LayoutKind layout : {ui::LayoutKind::volume, ui::LayoutKind::b_scan,
                                        ui::LayoutKind::microscope, ui::LayoutKind::quad})
      for (const ui::StereoMode stereo :
           {ui::StereoMode::off, ui::StereoMode::side_by_side, ui::StereoMode::top_bottom})
        for (const ui::Technique technique : ui::all_techniques) {
          view_.layout = layout;
          view_.stereo = stereo;
          view_.technique = technique;
          EXPECT_TRUE(renderer_->show_volume(volume_));
          EXPECT_TRUE(renderer_->draw(view_, status_, 320, 180, {0.5F, 60, {}}));
        }
  });
}

} // namespace
} // namespace octascope::tests
