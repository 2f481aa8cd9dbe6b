// What the render loop expects of the volumes, and when it says that one is seen.
#include "tests/firmware-host/run/loop_stage.h"

namespace octascope::tests {
namespace {

using namespace std::chrono_literals;
using pipeline::Showing;

// Hands everything on and remembers what is asked for.
class WatchedFeed final : public pipeline::VolumeFeed {
public:
  explicit WatchedFeed(pipeline::VolumeFeed& feed) : feed_(feed) {}

  Showing expected = Showing::nothing; // by the last turn
  int begun = 0;
  int drawn = 0;

private:
  const pipeline::Volume* do_take_newest() override { return feed_.take_newest(); }
  bool do_has_newer() const override { return feed_.has_newer(); }
  std::optional<pipeline::VolumeInMaking> do_borrow_after(std::uint64_t after) override {
    return feed_.borrow_after(after);
  }
  void do_give_back() override { feed_.give_back(); }
  void do_expect(Showing how) override {
    expected = how;
    feed_.expect(how);
  }
  void do_note_begun() override {
    ++begun;
    feed_.note_begun();
  }
  void do_note_drawn() override {
    ++drawn;
    feed_.note_drawn();
  }
  bool do_lends() const override { return feed_.lends(); }
  bool do_has_flow() const override { return feed_.has_flow(); }
  pipeline::VolumeCounters do_counters() const override { return feed_.counters(); }

  pipeline::VolumeFeed& feed_;
};

class RightOfWayLoop : public LoopStage {
protected:
  void start_watched(bool rolling) {
    firmware_host::RenderLoopSetup live = setup();
    live.view.rolling = rolling;
    live.lines_per_frame = plan().lines_per_frame();
    live.freshness.volume_period = plan().tick_period();
    feed_.emplace(*volumes_);
    open(std::move(live), *feed_, acquisition_.get(), scope_thread_.get());
  }
  void TearDown() override {
    loop_.reset(); // before what it borrows
    LoopStage::TearDown();
  }

  std::optional<WatchedFeed> feed_;
};

TEST_F(RightOfWayLoop, ends_with_the_first_frame_that_shows_the_volume) {
  start_watched(false);
  turn();
  EXPECT_EQ(feed_->expected, Showing::whole);
  EXPECT_EQ(feed_->drawn, 0) << "there is no volume";
  send_volume(Tissue::usual);
  EXPECT_EQ(feed_->drawn, 0) << "no frame shows it";
  turn();
  EXPECT_EQ(feed_->drawn, 1);
  turn_knob(1, 1);
  turn();
  EXPECT_EQ(feed_->drawn, 1) << "it is the same volume";
  send_volume(Tissue::reversed);
  turn();
  EXPECT_EQ(feed_->drawn, 2);
}

TEST_F(RightOfWayLoop, is_not_asked_for_while_b_scans_are_shown_as_they_come) {
  start_watched(true);
  send_volume(Tissue::usual);
  turn();
  turn();
  EXPECT_EQ(feed_->expected, Showing::rolling);
  EXPECT_EQ(feed_->begun, 1) << "nothing more has come";
  EXPECT_GE(feed_->drawn, 1);
}

TEST_F(RightOfWayLoop, is_not_asked_for_without_a_display) {
  start_watched(false);
  send_volume(Tissue::usual);
  turn();
  display_.cable().lose();
  send_volume(Tissue::reversed);
  turn();
  turn();
  EXPECT_EQ(feed_->expected, Showing::nothing);
  display_.cable().restore();
  turn_until(clock_.now() + 3s); // the longest that it waits before it tries again
  EXPECT_EQ(feed_->expected, Showing::whole);
}

TEST_F(RightOfWayLoop, is_not_asked_for_while_the_picture_is_frozen) {
  start_watched(false);
  send_volume(Tissue::usual);
  turn();
  press_freeze();
  turn();
  turn();
  EXPECT_EQ(feed_->expected, Showing::nothing);
  press_freeze();
  turn();
  turn();
  EXPECT_EQ(feed_->expected, Showing::whole);
}

} // namespace
} // namespace octascope::tests
