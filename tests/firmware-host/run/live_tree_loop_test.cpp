// The render loop with trees that are traced in its volumes.
#include <chrono>
#include <functional>
#include <thread>
#include <utility>

#include "tests/firmware-host/run/loop_stage.h"
#include "tests/support/pictures/picture_counts.h"
#include "tests/support/vessels/live_flow.h"
#include "tests/ui/support/synthetic_volume.h"

namespace octascope::tests {
namespace {

using namespace std::chrono_literals;
using State = ui::VesselStatus::State;
using Traced = ui::TracedTreeStatus::State;

// One volume at a time, as from the pipeline.
class FlowFeed final : public pipeline::VolumeFeed {
public:
  void publish(pipeline::Volume volume, hal::TimePoint last_line) {
    newest_ = std::move(volume);
    newest_.metadata.index = ++count_;
    newest_.metadata.last_line = last_line;
    fresh_ = true;
  }

private:
  const pipeline::Volume* do_take_newest() override {
    return std::exchange(fresh_, false) ? &newest_ : nullptr;
  }
  bool do_has_newer() const override { return fresh_; }
  pipeline::VolumeCounters do_counters() const override { return {}; }

  pipeline::Volume newest_;
  std::uint64_t count_ = 0;
  bool fresh_ = false;
};

class LiveTreeLoop : public LoopStage {
protected:
  void SetUp() override {
    LoopStage::SetUp();
    if (IsSkipped())
      return;
    with_flow_ = tissue_volume(small_geometry);
    add_live_flow(with_flow_);
    vessels_ = std::make_unique<firmware_host::VesselDisplay>(
        firmware_host::VesselDisplaySetup{
            .file = {}, .registration_file = {}, .registration = {}, .operated = {}, .live = true},
        clock_, faults_, news_);
    open(setup(), feed_, nullptr, nullptr);
  }
  void TearDown() override {
    LoopStage::TearDown();
    vessels_.reset();
  }
  void send(const pipeline::Volume& volume) {
    turn_until(clock_.now() + 141ms);
    feed_.publish(volume, clock_.now());
    turn();
  }
  // Volumes come until it is so; the threads beside have time of their own.
  bool send_until(const pipeline::Volume& volume, const std::function<bool()>& so) {
    for (int i = 0; i < 200; ++i) {
      if (so())
        return true;
      send(volume);
      std::this_thread::sleep_for(20ms);
    }
    return false;
  }
  const ui::VesselStatus& vessels() const { return loop_->status().vessels; }
  // Pixels that are different in the volume's middle, away from all words.
  int differing(const pipeline::Image& before) {
    rest();
    const ui::Rect all = layout().view;
    return count_different(
        before, display_.picture,
        {all.x + all.width / 4, all.y + all.height / 4, all.width / 2, all.height / 2}, 0);
  }
  const pipeline::Image& at_rest() {
    rest();
    return display_.picture;
  }

  FlowFeed feed_;
  pipeline::Volume with_flow_;
};

TEST_F(LiveTreeLoop, shows_the_tree_of_the_newest_volume_and_removes_an_old_one) {
  const pipeline::Volume without = tissue_volume(small_geometry);
  send(without);
  const pipeline::Image bare = at_rest();
  EXPECT_FALSE(vessels().traced);
  ASSERT_TRUE(send_until(with_flow_, [&] { return vessels().state == State::shown; }));
  EXPECT_TRUE(vessels().registered);
  EXPECT_EQ(vessels().traced.value().state, Traced::shown);
  EXPECT_EQ(vessels().traced->vessels, 3U);
  EXPECT_GT(differing(bare), 500);
  const hal::TimePoint last = clock_.now();
  while (clock_.now() < last + ui::TracedTreeStatus::removed_after + 1s)
    send(without); // no flow any more: it could not be told
  EXPECT_EQ(vessels().state, State::none);
  EXPECT_EQ(vessels().traced->state, Traced::removed);
  EXPECT_EQ(differing(bare), 0);
  EXPECT_GE(loop_->traced_trees().value().traced, 1U);
}

TEST_F(LiveTreeLoop, a_display_that_comes_back_shows_the_tree_again) {
  ASSERT_TRUE(send_until(with_flow_, [&] { return vessels().state == State::shown; }));
  const pipeline::Image before = at_rest();
  display_.cable().lose();
  turn_until(clock_.now() + 1s);
  display_.cable().restore();
  turn_until(clock_.now() + 3s);
  send(with_flow_);
  EXPECT_EQ(differing(before), 0);
}

} // namespace
} // namespace octascope::tests
