// B-scans that are shown as they come: where the seam is, how old either side is, and what takes
// whole volumes all the same.
#include "tests/firmware-host/run/loop_stage.h"
#include "tests/support/pictures/picture_counts.h"
#include "ui/canvas/palette.h"

namespace octascope::tests {
namespace {

using namespace std::chrono_literals;
using ui::Liveness;

class RollingLoop : public LoopStage {
protected:
  static ui::ViewState rolling_view(int b_scan = 5) {
    ui::ViewState view;
    view.rolling = true;
    view.zoom_to_tissue = false;
    view.b_scan = b_scan;
    return view;
  }
  // Half of a volume is over the one before.
  void start_with_a_seam(const ui::ViewState& view) {
    start(view);
    send_scope_picture();
    send_volume(Tissue::usual);
    turn();
    send_b_scans(Tissue::reversed, 0, 21);
    turn();
  }
  int seam_pixels() const {
    return count_colour(display_.picture, layout().en_face.picture, ui::palette::seam);
  }
  ui::Rect b_scan_panel() const {
    ui::Rect panel = layout().b_scan.picture;
    return {panel.x + panel.width / 4, panel.y, panel.width / 2, panel.height / 2}; // no marks
  }
  // Whose B-scan the panel shows.
  bool panel_shows(Tissue tissue) const {
    auto renderer = ui::Renderer::create();
    EXPECT_TRUE(renderer);
    EXPECT_TRUE((*renderer)->show_volume(tissues_[static_cast<std::size_t>(tissue)]));
    EXPECT_TRUE((*renderer)->show_scope_picture(scope_picture_.frame(clock_.now()), std::nullopt));
    EXPECT_TRUE((*renderer)->draw(view(), loop_->status(), display_.width(), display_.height(),
                                  loop_->quality()));
    const auto picture = (*renderer)->read_back(display_.width(), display_.height());
    return count_different(picture, display_.picture, b_scan_panel(), 2) == 0;
  }
  const std::optional<ui::RollingStatus>& rolling() const { return loop_->status().rolling; }
};

TEST_F(RollingLoop, shows_each_b_scan_before_its_volume_is_whole_and_says_how_old_it_is) {
  start(rolling_view());
  send_scope_picture();
  send_volume(Tissue::usual);
  turn();
  ASSERT_TRUE(rolling());
  EXPECT_FALSE(rolling()->seam);
  EXPECT_EQ(seam_pixels(), 0);
  EXPECT_TRUE(panel_shows(Tissue::usual));
  const hal::TimePoint older = exposed(21);

  send_b_scans(Tissue::reversed, 0, 21);
  const auto counted = loop_->line_latency().count;
  turn();
  ASSERT_TRUE(rolling()->seam);
  const hal::TimePoint now = loop_->status().now;
  // Number 20 waits for its neighbour: the seam lies on it, between number 19 and an old 21.
  EXPECT_LE(std::chrono::abs(rolling()->seam->newer - (now - exposed(20))), plan().frame_period());
  EXPECT_LE(std::chrono::abs(rolling()->seam->older - (now - older)), plan().frame_period());
  EXPECT_GT(rolling()->seam->older, rolling()->seam->newer + 100ms);
  EXPECT_GT(seam_pixels(), 20);
  EXPECT_TRUE(panel_shows(Tissue::reversed)) << "it is before the seam";
  EXPECT_GT(loop_->line_latency().count, counted);
  EXPECT_EQ(loop_->status().freshness.liveness, Liveness::live);

  send_b_scans(Tissue::reversed, 21, 40);
  turn();
  EXPECT_FALSE(rolling()->seam);
  EXPECT_EQ(loop_->statistics().volumes_displayed, 2U);
}

TEST_F(RollingLoop, a_b_scan_behind_the_seam_is_still_the_older_one) {
  start_with_a_seam(rolling_view(30));
  EXPECT_TRUE(panel_shows(Tissue::usual));
}

TEST_F(RollingLoop, what_is_frozen_is_whole) {
  start_with_a_seam(rolling_view());
  ASSERT_GT(seam_pixels(), 20);
  press_freeze();
  turn();
  ASSERT_TRUE(view().frozen);
  EXPECT_EQ(seam_pixels(), 0);
  EXPECT_TRUE(panel_shows(Tissue::usual));
  press_freeze();
  turn();
  ASSERT_FALSE(view().frozen);
  EXPECT_GT(seam_pixels(), 20);
  EXPECT_TRUE(panel_shows(Tissue::reversed));
}

TEST_F(RollingLoop, a_volume_that_was_finished_while_frozen_is_shown_whole) {
  start_with_a_seam(rolling_view());
  press_freeze();
  turn();
  ASSERT_TRUE(panel_shows(Tissue::usual));
  send_b_scans(Tissue::reversed, 21, 40);
  press_freeze();
  turn();
  ASSERT_FALSE(view().frozen);
  EXPECT_EQ(seam_pixels(), 0);
  EXPECT_TRUE(panel_shows(Tissue::reversed)) << "of what had come before the freeze, too";
}

TEST_F(RollingLoop, a_surface_stays_whole_and_says_so) {
  ui::ViewState view = rolling_view();
  view.technique = ui::Technique::surface;
  start(view);
  send_volume(Tissue::usual);
  turn();
  send_b_scans(Tissue::reversed, 0, 21);
  turn();
  ASSERT_TRUE(rolling());
  EXPECT_FALSE(rolling()->possible);
  EXPECT_FALSE(rolling()->seam);
}

TEST_F(RollingLoop, whole_volumes_are_the_default) {
  start({});
  send_volume(Tissue::usual);
  turn();
  send_b_scans(Tissue::reversed, 0, 21);
  turn();
  EXPECT_FALSE(rolling());
  EXPECT_EQ(seam_pixels(), 0);
}

TEST_F(RollingLoop, b_scans_that_stop_coming_age_on_both_sides_until_the_picture_is_stale) {
  start(rolling_view());
  send_volume(Tissue::usual);
  const hal::TimePoint arrived = clock_.now();
  turn();
  send_b_scans(Tissue::reversed, 0, 21);
  turn();
  ASSERT_TRUE(rolling()->seam);
  const ui::RollingStatus::Seam before = *rolling()->seam;
  const hal::TimePoint then = loop_->status().now;
  camera_.unplug();
  const hal::Duration due = plan().tick_period() * 3 / 2;
  while (loop_->status().now <= arrived + due) {
    EXPECT_EQ(loop_->status().freshness.liveness, Liveness::live);
    turn();
  }
  EXPECT_EQ(loop_->status().freshness.liveness, Liveness::stale);
  ASSERT_TRUE(rolling()->seam);
  EXPECT_EQ(rolling()->seam->newer - before.newer, loop_->status().now - then);
  EXPECT_EQ(rolling()->seam->older - before.older, loop_->status().now - then);
}

} // namespace
} // namespace octascope::tests
