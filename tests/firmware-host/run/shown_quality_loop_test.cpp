// The quality that a run reports is that of the frames that were shown.
#include <algorithm>
#include <vector>

#include "tests/firmware-host/run/loop_stage.h"

namespace octascope::tests {
namespace {

using namespace std::chrono_literals;

class QualityOfARun : public LoopStage {
protected:
  // Keeps the quality of every frame in which something of the volume differs from the last one.
  void draw_at(hal::Duration full) {
    longest_turn_ = 130ms;
    draw_for(full, 1ms, [this](const ui::DrawQuality& quality) { drawn_.push_back(quality); });
  }

  void show_volumes(int volumes) {
    for (int i = 0; i < volumes; ++i) {
      send_volume(i % 2 == 0 ? Tissue::usual : Tissue::reversed);
      turn();
    }
  }

  firmware_host::QualitySummary told() const { return loop_->statistics().quality.summary(); }

  void expect_told_as_drawn() const {
    ASSERT_FALSE(drawn_.empty());
    std::vector<double> resolutions;
    std::vector<double> steps;
    for (const ui::DrawQuality& quality : drawn_) {
      resolutions.push_back(static_cast<double>(quality.resolution));
      steps.push_back(quality.steps);
    }
    std::ranges::sort(resolutions);
    std::ranges::sort(steps);
    const std::size_t middle = (drawn_.size() - 1) / 2;
    EXPECT_EQ(told().frames, drawn_.size());
    ASSERT_TRUE(told().resolution && told().steps);
    EXPECT_NEAR(told().resolution->median, resolutions[middle], 1e-6);
    EXPECT_NEAR(told().resolution->worst, resolutions.front(), 1e-6);
    EXPECT_EQ(told().steps->median, steps[middle]);
    EXPECT_EQ(told().steps->worst, steps.front());
  }

  std::vector<ui::DrawQuality> drawn_;
};

TEST_F(QualityOfARun, is_low_where_the_governor_was_forced_low) {
  start({});
  draw_at(300ms);
  show_volumes(24);
  expect_told_as_drawn();
  EXPECT_LE(told().resolution->worst, 0.5);
  EXPECT_LE(told().resolution->median, 0.5);
  EXPECT_LE(told().steps->median, 192);
}

TEST_F(QualityOfARun, is_high_where_drawing_costs_little) {
  start({});
  draw_at(2ms);
  show_volumes(24);
  expect_told_as_drawn();
  EXPECT_EQ(told().resolution->median, 1);
  EXPECT_EQ(told().steps->median, ui::full_quality.steps);
}

TEST_F(QualityOfARun, counts_no_frame_that_leaves_the_volume_as_it_is_and_none_that_nobody_saw) {
  start({});
  draw_at(2ms);
  send_scope_picture(); // from here on it has a place
  show_volumes(3);
  rest();
  const std::uint64_t frames = told().frames;
  const int shown = display_.frames;
  send_scope_picture();
  turn();
  ASSERT_GT(display_.frames, shown) << "nothing was drawn at all";
  EXPECT_EQ(told().frames, frames);
  resume_sweeps();
  display_.covered = true;
  show_volumes(1);
  EXPECT_EQ(told().frames, frames);
  display_.covered = false;
  show_volumes(1);
  EXPECT_GT(told().frames, frames);
}

} // namespace
} // namespace octascope::tests
