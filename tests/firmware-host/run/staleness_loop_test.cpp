// When the picture says that it is old, frame by frame on a time axis that stands still between them.
#include <optional>

#include "tests/firmware-host/run/loop_stage.h"
#include "tests/support/pictures/picture_counts.h"
#include "ui/canvas/palette.h"

namespace octascope::tests {
namespace {

using namespace std::chrono_literals;
using ui::Liveness;

// Says of volumes that they were passed over.
class PassingFeed final : public pipeline::VolumeFeed {
public:
  explicit PassingFeed(pipeline::VolumeFeed& feed) : feed_(feed) {}

  std::uint64_t passed_over = 0;

private:
  const pipeline::Volume* do_take_newest() override { return feed_.take_newest(); }
  bool do_has_newer() const override { return feed_.has_newer(); }
  pipeline::VolumeCounters do_counters() const override {
    pipeline::VolumeCounters counters = feed_.counters();
    counters.passed_over = passed_over;
    return counters;
  }

  pipeline::VolumeFeed& feed_;
};

class Staleness : public LoopStage {
protected:
  int badge_pixels() const {
    return count_colour(display_.picture, layout().marks, ui::palette::warning);
  }

  // From the last volume's arrival on no other comes. Returns when the first frame that says so
  // was on the glass, counted from the arrival; expects that all before it said nothing.
  hal::Duration first_stale_frame(hal::TimePoint arrived) {
    const hal::Duration due = plan().tick_period() * 3 / 2;
    camera_.unplug();
    while (clock_.now() < arrived + 20 * due) {
      const int frames = display_.frames;
      turn();
      const hal::Duration waited = loop_->status().now - arrived;
      const bool stale = loop_->status().freshness.liveness == Liveness::stale;
      EXPECT_EQ(stale, waited > due) << "judged after " << hal::to_ms(waited) << " ms";
      if (stale) {
        EXPECT_EQ(display_.frames, frames + 1) << "judged, and not told";
        EXPECT_GT(badge_pixels(), 10);
        return display_.completed - arrived;
      }
      EXPECT_EQ(badge_pixels(), 0) << "after " << hal::to_ms(waited) << " ms";
    }
    ADD_FAILURE() << "never";
    return {};
  }

  // Volumes come, each shown at once; returns when the last one did.
  hal::TimePoint run_live(int volumes, int detents_each) {
    hal::TimePoint arrived;
    for (int i = 0; i < volumes; ++i) {
      send_volume(i % 2 == 0 ? Tissue::usual : Tissue::reversed);
      if (HasFatalFailure())
        return {};
      arrived = clock_.now();
      if (detents_each != 0)
        turn_knob(1, detents_each);
      turn();
      EXPECT_EQ(loop_->status().freshness.liveness, Liveness::live);
      EXPECT_EQ(badge_pixels(), 0);
    }
    return arrived;
  }

  hal::Duration due() const { return plan().tick_period() * 3 / 2; }
};

TEST_F(Staleness, is_told_one_and_a_half_periods_after_the_last_volume_and_not_before) {
  start({});
  const hal::Duration told = first_stale_frame(run_live(4, 0));
  EXPECT_GT(told, due());
  // Judged at the first refresh after it is due, and on the glass at the next.
  EXPECT_LE(told, due() + 2 * display_.refresh_period());
}

class StalenessOfThePassedOver : public Staleness {
protected:
  // Shows a volume; then so many are passed over, and nothing comes any more.
  void pass_over(std::uint64_t volumes) {
    feed_.emplace(*volumes_);
    firmware_host::RenderLoopSetup live = setup();
    live.freshness.volume_period = plan().tick_period();
    open(std::move(live), *feed_, acquisition_.get(), scope_thread_.get());
    feed_->passed_over = 5; // before the volume that is shown
    turn();
    arrived_ = run_live(1, 0);
    clock_.sleep_until(arrived_ + due() - 1ms);
    turn();
    EXPECT_EQ(loop_->status().freshness.liveness, Liveness::live);
    feed_->passed_over += volumes;
  }
  void expect_stale_at(hal::Duration since_it_was_due) {
    turn_until(arrived_ + due() + since_it_was_due - 30ms);
    EXPECT_EQ(loop_->status().freshness.liveness, Liveness::live);
    turn_until(arrived_ + due() + since_it_was_due + 30ms);
    EXPECT_EQ(loop_->status().freshness.liveness, Liveness::stale);
  }
  void TearDown() override {
    loop_.reset(); // before the feed
    Staleness::TearDown();
  }

  std::optional<PassingFeed> feed_;
  hal::TimePoint arrived_;
};

// They came, and their successor is due one period after them.
TEST_F(StalenessOfThePassedOver, is_told_as_much_later) {
  pass_over(2);
  expect_stale_at(2 * plan().tick_period());
}

// As after a frame that took seconds.
TEST_F(StalenessOfThePassedOver, is_told_soon_however_many_they_are) {
  pass_over(1000);
  expect_stale_at(300ms);
}

TEST_F(Staleness, does_not_wait_for_a_finer_picture) {
  start({});
  draw_for(300ms, 2ms);
  longest_turn_ = 130ms;
  const hal::TimePoint last = run_live(12, 0);
  const ui::DrawQuality live = loop_->quality();
  ASSERT_LT(ui::sample_share(live), 0.2) << "the governor had no reason to draw coarsely";
  const hal::Duration told = first_stale_frame(last);
  EXPECT_GT(told, due());
  EXPECT_LE(told, due() + 2 * display_.refresh_period() + 2ms);
  EXPECT_EQ(loop_->quality(), live);
  turn();
  EXPECT_EQ(ui::sample_share(loop_->quality()), 1)
      << "what stands still is drawn as finely as it can";
}

// As at a line rate of which frames are slower than volumes.
TEST_F(Staleness, of_volumes_that_keep_coming_makes_no_picture_finer) {
  firmware_host::RenderLoopSetup quick = setup();
  quick.freshness.volume_period = 20ms;
  open(std::move(quick), *volumes_, acquisition_.get(), scope_thread_.get());
  draw_for(200ms, 2ms);
  longest_turn_ = 130ms;
  for (int i = 0; i < 12; ++i) {
    send_volume(i % 2 == 0 ? Tissue::usual : Tissue::reversed);
    if (HasFatalFailure())
      return;
    clock_.advance(35ms);
    turn();
    ASSERT_EQ(loop_->status().freshness.liveness, Liveness::stale);
    ASSERT_LT(ui::sample_share(loop_->quality()), 0.4) << "frame " << i;
  }
  EXPECT_LT(ui::sample_share(loop_->quality()), 0.2);
}

TEST_F(Staleness, is_told_while_the_view_moves_and_frames_are_slow) {
  start({});
  draw_for(300ms, 2ms);
  longest_turn_ = 130ms;
  const hal::TimePoint last = run_live(12, 1);
  turn_knob(1, 1);
  const hal::Duration told = first_stale_frame(last);
  EXPECT_GT(told, due());
  // The frame before it may have begun just before it was due; each is within its budget.
  EXPECT_LE(told, due() + 2 * (display_.refresh_period() * 18 / 10 + display_.refresh_period()));
}

TEST_F(Staleness, ends_with_the_next_volume) {
  start({});
  first_stale_frame(run_live(2, 0));
  resume_sweeps();
  EXPECT_GT(badge_pixels(), 10);
  run_live(2, 0);
}

TEST_F(Staleness, freezing_is_told_before_the_picture_gets_finer) {
  start({});
  draw_for(300ms, 2ms);
  longest_turn_ = 130ms;
  run_live(12, 0);
  press_freeze();
  const hal::TimePoint pressed = clock_.now();
  turn();
  ASSERT_TRUE(view().frozen);
  EXPECT_GT(count_colour(display_.picture, layout().marks, ui::palette::frozen), 10);
  EXPECT_LE(display_.completed, pressed + 2 * display_.refresh_period());
}

} // namespace
} // namespace octascope::tests
