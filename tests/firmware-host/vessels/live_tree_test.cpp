// Trees traced beside the display: what is traced, what is drawn of it, and for how long.
#include <chrono>
#include <filesystem>
#include <functional>
#include <thread>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "firmware-host/vessels/live_tree_display.h"
#include "hal/linux/monotonic_clock.h"
#include "pipeline/vessels/files/swc_reader.h"
#include "pipeline/vessels/straight_nodes.h"
#include "pipeline/vessels/tracing/vessel_tracer.h"
#include "pipeline/vessels/tree_comparison.h"
#include "sim/clock/virtual_clock.h"
#include "tests/support/files/scratch_folder.h"
#include "tests/support/must.h"
#include "tests/support/vessels/live_flow.h"

namespace octascope::firmware_host {
namespace {

using namespace std::chrono_literals;
using State = ui::TracedTreeStatus::State;
using tests::live_flow;
using tests::moved_flow;

class LiveTreeTest : public testing::Test {
protected:
  // The volume's last line was exposed now.
  pipeline::Volume stamped(pipeline::Volume volume) {
    volume.metadata.index = ++volumes_;
    volume.metadata.last_line = clock_.now();
    return volume;
  }
  // Calls `step`, which moves no clock, until it has done what it should.
  static bool await(const std::function<bool()>& step) {
    for (int i = 0; i < 10'000; ++i) {
      if (step())
        return true;
      std::this_thread::sleep_for(1ms);
    }
    return false;
  }

  sim::VirtualClock clock_;
  pipeline::Wakeup news_;
  std::uint64_t volumes_ = 0;
};

class LiveTreeThreadTest : public LiveTreeTest {
protected:
  static constexpr hal::Duration interval = 700ms;

  // What becomes of the volume.
  std::shared_ptr<const LiveTree> traced(const pipeline::Volume& volume) {
    std::shared_ptr<const LiveTree> found;
    EXPECT_TRUE(await([&] {
      thread_.offer(volume, interval);
      found = thread_.take();
      return found != nullptr;
    }));
    return found;
  }

  LiveTreeThread thread_{clock_, news_};
};

TEST_F(LiveTreeThreadTest, traces_what_flows_in_the_volume) {
  const pipeline::Volume volume = stamped(live_flow());
  const hal::TimePoint exposed = clock_.now();
  const auto found = traced(volume);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->refusal, "");
  EXPECT_EQ(found->number, 1U);
  EXPECT_EQ(found->of_volume, exposed);
  EXPECT_EQ(found->volume_index, volume.metadata.index);
  const auto alone = pipeline::VesselTracer{}.trace(volume.geometry, volume.flow);
  ASSERT_TRUE(alone);
  EXPECT_EQ(found->tree.positions_mm, alone->tree.positions_mm);
  EXPECT_EQ(found->quality, alone->quality);
  EXPECT_GE(found->packed.value().clusters().segments, found->vessels);
  EXPECT_LT(found->packed->clusters().segments, found->tree.nodes() * 3 / 4) << "straight vessels";
  EXPECT_EQ(found->vessels, 3U);
  EXPECT_NEAR(found->length_mm, 5.2, 0.4);
  EXPECT_EQ(thread_.counters().traced, 1U);
  EXPECT_EQ(thread_.counters().refused, 0U);
  EXPECT_EQ(thread_.counters().took.count, 1U);
}

// A root, a straight trunk, a fork, a bent twig and a straight one that widens.
TEST(StraightNodes, alone_are_left_out) {
  pipeline::VesselTree tree;
  std::uint32_t at = tests::add_node(tree, {0, 0, 0}, 30, pipeline::no_parent);
  for (int i = 1; i <= 20; ++i)
    at = tests::add_node(tree, {30.0 * i, i % 2 == 0 ? 0.5 : -0.5, 0}, 30, at);
  const std::uint32_t fork = at;
  for (int i = 1; i <= 20; ++i)
    at = tests::add_node(tree, {600 + 20.0 * i, 1.0 * i * i, 0}, 20, at);
  at = fork;
  for (int i = 1; i <= 20; ++i)
    at = tests::add_node(tree, {600, 0, 20.0 * i}, i < 11 ? 20.0 : 26.0, at);
  const pipeline::VesselTree left = pipeline::without_straight_nodes(tree, 0.002);
  EXPECT_LT(left.nodes(), 30U);
  EXPECT_GT(left.nodes(), 10U);
  EXPECT_EQ(std::ranges::count(left.parents, pipeline::no_parent), 1);
  EXPECT_EQ(left.orders.size(), left.nodes());
  EXPECT_EQ(left.branches.size(), left.nodes());
  // Nothing of the one is far from the other, and as wide.
  const auto expect_within = [](const pipeline::VesselTree& one,
                                const pipeline::VesselTree& other) {
    const pipeline::TreeComparison compared = pipeline::compare_trees(one, other, {});
    EXPECT_EQ(compared.found_share, 1);
    EXPECT_LT(compared.distance.largest_um, 2.5);
    EXPECT_NEAR(compared.radius_bias_share, 0, 0.05);
  };
  expect_within(tree, left);
  expect_within(left, tree);
  EXPECT_EQ(pipeline::without_straight_nodes({}, 0.002).nodes(), 0U);
}

TEST_F(LiveTreeThreadTest, says_why_there_is_none) {
  const auto found = traced(stamped(moved_flow()));
  ASSERT_TRUE(found);
  EXPECT_EQ(found->refusal, "40 of 40 B-scans flow as a whole: motion, not vessels");
  EXPECT_EQ(found->tree.nodes(), 0U);
  EXPECT_FALSE(found->packed);
  EXPECT_EQ(thread_.counters().traced, 0U);
  EXPECT_EQ(thread_.counters().refused, 1U);
}

TEST_F(LiveTreeThreadTest, leaves_volumes_without_flow_and_those_that_it_had) {
  const pipeline::Volume without = stamped(pipeline::Volume{live_flow().geometry});
  for (int i = 0; i < 20; ++i) {
    thread_.offer(without, interval);
    std::this_thread::sleep_for(1ms);
  }
  const pipeline::Volume volume = stamped(live_flow());
  ASSERT_EQ(traced(volume)->number, 1U);
  clock_.advance(1s);
  thread_.offer(volume, interval);
  std::this_thread::sleep_for(50ms);
  EXPECT_EQ(thread_.take(), nullptr) << "it had this one";
  EXPECT_EQ(traced(stamped(live_flow()))->number, 2U);
}

TEST_F(LiveTreeThreadTest, traces_no_more_often_than_its_interval) {
  ASSERT_TRUE(traced(stamped(live_flow())));
  clock_.advance(interval - 1ms);
  thread_.offer(stamped(live_flow()), interval);
  std::this_thread::sleep_for(50ms);
  EXPECT_EQ(thread_.take(), nullptr);
  clock_.advance(1ms);
  EXPECT_TRUE(traced(stamped(live_flow())));
}

TEST_F(LiveTreeThreadTest, rather_begins_when_a_volume_comes) {
  ASSERT_TRUE(traced(stamped(live_flow())));
  clock_.advance(interval - 1ms);
  const pipeline::Volume volume = stamped(live_flow());
  thread_.offer(volume, interval);
  clock_.advance(LiveTreeThread::patience);
  thread_.offer(volume, interval);
  EXPECT_FALSE(thread_.is_at_work()) << "in the midst of its time";
  clock_.advance(1ms);
  EXPECT_TRUE(traced(volume)) << "nothing else comes";
}

// The render thread goes on to the next volume at once, and its memory is filled anew.
TEST_F(LiveTreeThreadTest, has_a_copy_of_what_it_works_on) {
  pipeline::Volume volume = stamped(live_flow());
  const auto alone = pipeline::VesselTracer{}.trace(volume.geometry, volume.flow);
  ASSERT_TRUE(await([&] {
    thread_.offer(volume, interval);
    return thread_.is_at_work();
  }));
  std::ranges::fill(volume.flow, pipeline::flow_untold);
  std::shared_ptr<const LiveTree> found;
  ASSERT_TRUE(await([&] { return (found = thread_.take()) != nullptr; }));
  EXPECT_EQ(found->tree.positions_mm, alone->tree.positions_mm);
}

TEST_F(LiveTreeThreadTest, ends_in_the_middle_of_a_tree) {
  const hal::linux_backend::MonotonicClock clock;
  auto thread = std::make_unique<LiveTreeThread>(clock_, news_);
  const pipeline::Volume volume = stamped(live_flow());
  ASSERT_TRUE(await([&] {
    thread->offer(volume, interval);
    return thread->is_at_work();
  }));
  thread.reset(); // under the sanitizers: nothing is left behind
}

class LiveTreeDisplayTest : public LiveTreeTest {
protected:
  // Until the volume's tree, or refusal, has come: it is as old as it may have to wait.
  void show(const pipeline::Volume& volume) {
    advance(volume, false);
    clock_.advance(LiveTreeDisplay::longest_wait);
    ASSERT_TRUE(await([&] {
      advance(volume, false);
      return display_.newest() != nullptr &&
             display_.newest()->volume_index == volume.metadata.index;
    }));
  }

  // A turn of the loop with that picture.
  bool advance(const pipeline::Volume& shown, bool frozen, bool seen = true) {
    const bool changed = display_.advance(&shown, frozen);
    display_.trace(shown, seen);
    return changed;
  }

  LiveTreeDisplay display_{clock_, news_};
};

TEST_F(LiveTreeDisplayTest, draws_the_newest_tree_and_none_that_is_refused) {
  show(stamped(live_flow()));
  ASSERT_NE(display_.drawn(), nullptr);
  EXPECT_EQ(display_.status()->state, State::shown);
  EXPECT_EQ(display_.status()->vessels, 3U);
  clock_.advance(1s);
  show(stamped(moved_flow()));
  EXPECT_EQ(display_.drawn(), nullptr);
  EXPECT_EQ(display_.status()->state, State::refused);
  EXPECT_EQ(display_.status()->refusal, "40 of 40 B-scans flow as a whole");
  clock_.advance(1s);
  show(stamped(live_flow()));
  EXPECT_EQ(display_.drawn(), display_.newest().get());
}

// The tree is there, but in the picture of a new volume it is not taken yet.
class LiveTreeBesideVolumes : public LiveTreeDisplayTest {
protected:
  void SetUp() override {
    show(stamped(live_flow()));
    clock_.advance(LiveTreeDisplay::interval_seen - 1ms);
    const pipeline::Volume next = stamped(live_flow());
    advance(next, false);
    advance(next, false); // the picture after it
    clock_.advance(LiveTreeThread::patience + 1ms);
    advance(next, false); // is traced from now on
    for ([[maybe_unused]] const char* news : {"started", "a tree", "another"})
      news_.wait();
    clock_.advance(1ms);
    const pipeline::Volume newer = stamped(live_flow());
    advance(newer, false);
    EXPECT_NE(display_.newest()->volume_index, next.metadata.index);
    traced_ = next.metadata.index;
    shown_ = newer;
  }
  std::uint64_t traced_ = 0;
  pipeline::Volume shown_;
};

TEST_F(LiveTreeBesideVolumes, waits_for_the_next_picture) {
  advance(shown_, false);
  EXPECT_EQ(display_.newest()->volume_index, traced_);
}

TEST_F(LiveTreeBesideVolumes, that_comes_later_waits_for_the_next_volume) {
  advance(shown_, false);
  clock_.advance(LiveTreeDisplay::interval_seen + LiveTreeThread::patience);
  advance(shown_, false); // is traced from now on
  news_.wait();
  clock_.advance(1ms);
  const pipeline::Volume newest = stamped(live_flow());
  advance(newest, false);
  EXPECT_EQ(display_.newest()->volume_index, traced_);
  clock_.advance(1ms);
  advance(newest, false);
  EXPECT_EQ(display_.newest()->volume_index, shown_.metadata.index);
}

TEST_F(LiveTreeBesideVolumes, waits_once_where_each_picture_is_of_a_new_volume) {
  clock_.advance(1ms);
  const pipeline::Volume newest = stamped(live_flow());
  advance(newest, false);
  EXPECT_EQ(display_.newest()->volume_index, traced_);
}

TEST_F(LiveTreeDisplayTest, tells_the_age_and_removes_a_tree_that_is_old) {
  const pipeline::Volume volume = stamped(live_flow());
  show(volume);
  clock_.advance(ui::TracedTreeStatus::removed_after - LiveTreeDisplay::longest_wait - 1ms);
  EXPECT_FALSE(advance(volume, false));
  EXPECT_NE(display_.drawn(), nullptr);
  EXPECT_EQ(display_.status()->age, ui::TracedTreeStatus::removed_after - 1ms);
  clock_.advance(1ms);
  EXPECT_TRUE(advance(volume, false)) << "another picture";
  EXPECT_EQ(display_.drawn(), nullptr);
  EXPECT_EQ(display_.status()->state, State::removed);
}

TEST_F(LiveTreeDisplayTest, traces_seldom_what_nobody_sees) {
  show(stamped(live_flow()));
  clock_.advance(LiveTreeDisplay::interval_unseen - LiveTreeDisplay::longest_wait - 1ms);
  const pipeline::Volume volume = stamped(live_flow());
  for (int i = 0; i < 50; ++i) {
    advance(volume, false, false);
    std::this_thread::sleep_for(1ms);
  }
  EXPECT_NE(display_.newest()->volume_index, volume.metadata.index);
  EXPECT_NE(display_.drawn(), nullptr) << "and may be shown at once";
  clock_.advance(LiveTreeThread::patience + 1ms);
  advance(volume, false, false);
  clock_.advance(LiveTreeDisplay::longest_wait);
  EXPECT_TRUE(await([&] {
    advance(volume, false, false);
    return display_.newest()->volume_index == volume.metadata.index;
  }));
}

// As old as when the picture stood still, and then the frozen volume's own.
TEST_F(LiveTreeDisplayTest, keeps_the_tree_of_a_frozen_picture) {
  show(stamped(live_flow()));
  clock_.advance(LiveTreeDisplay::interval_seen / 2);
  const pipeline::Volume frozen = stamped(live_flow());
  advance(frozen, true);
  const hal::Duration age = LiveTreeDisplay::longest_wait + LiveTreeDisplay::interval_seen / 2;
  EXPECT_EQ(display_.status()->age, age);
  clock_.advance(10min);
  ASSERT_TRUE(await([&] {
    advance(frozen, true);
    return display_.newest()->volume_index == frozen.metadata.index;
  }));
  EXPECT_EQ(display_.status()->age, 0s);
  EXPECT_EQ(display_.drawn(), display_.newest().get());
  advance(frozen, false);
  EXPECT_EQ(display_.drawn(), nullptr) << "live again, it is ten minutes old";
}

TEST_F(LiveTreeDisplayTest, keeps_the_drawn_tree_in_a_file_for_its_owner) {
  const tests::ScratchFolder folder;
  display_.keep(folder / ".");
  EXPECT_FALSE(display_.take_kept()) << "none is drawn";
  show(stamped(live_flow()));
  display_.keep(folder / ".");
  std::optional<hal::Result<std::filesystem::path>> kept;
  ASSERT_TRUE(await([&] { return (kept = display_.take_kept()).has_value(); }));
  const std::filesystem::path file = tests::must(std::move(*kept));
  pipeline::TreeReadOptions options;
  options.forest = true;
  const auto read = tests::must(pipeline::read_swc(file, options));
  EXPECT_EQ(read.tree.positions_mm, display_.drawn()->tree.positions_mm);
  EXPECT_EQ(std::filesystem::status(file).permissions(),
            std::filesystem::perms::owner_read | std::filesystem::perms::owner_write);
}

} // namespace
} // namespace octascope::firmware_host
