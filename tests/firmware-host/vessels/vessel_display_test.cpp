// A loaded tree that is registered to what flows, and what becomes of it when nothing can be traced any more.
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <random>
#include <thread>

#include <gtest/gtest.h>

#include "firmware-host/vessels/vessel_display.h"
#include "pipeline/vessels/files/swc_writer.h"
#include "sim/clock/virtual_clock.h"
#include "tests/support/files/scratch_folder.h"
#include "tests/support/vessels/live_flow.h"

namespace octascope::firmware_host {
namespace {

using namespace std::chrono_literals;
using State = ui::VesselStatus::State;
using Followed = ui::FollowedTreeStatus;

// Vessels that fit one another in one place alone.
pipeline::VesselTree bed() {
  pipeline::VesselTree tree;
  tests::add_tube(tree, {0, 500, 400}, {3000, 900, 700}, 100);
  tests::add_tube(tree, {300, 1600, 1300}, {2900, 1350, 1000}, 100);
  tests::add_tube(tree, {1500, 1900, 400}, {1700, 2950, 1200}, 100);
  tests::add_tube(tree, {300, 2300, 600}, {1100, 2900, 1400}, 100);
  tests::add_tube(tree, {2300, 1900, 500}, {2800, 2900, 700}, 100);
  tests::add_tube(tree, {700, 100, 1300}, {2500, 250, 1500}, 100);
  tree.branches.assign(tree.nodes(), pipeline::VesselBranch::unknown);
  tree.orders.assign(tree.nodes(), 0);
  return tree;
}

pipeline::Volume perfused(const pipeline::VesselTree& tree) {
  pipeline::Volume volume{tests::live_flow_geometry};
  std::ranges::fill(volume.b_scan_states, pipeline::BScanState::good);
  std::mt19937 random{1};
  for (std::uint8_t& level : volume.levels)
    level = static_cast<std::uint8_t>(random() % 200);
  volume.add_flow();
  std::ranges::transform(tests::flow_of(tree, volume.geometry), volume.flow.begin(),
                         pipeline::quantise_flow);
  std::ranges::fill(volume.flow_states, pipeline::FlowState::told);
  return volume;
}

class FollowedVesselsTest : public testing::Test {
protected:
  FollowedVesselsTest() {
    const pipeline::VesselTree tree = bed();
    volume_ = perfused(tree);
    EXPECT_TRUE(pipeline::write_swc(file_, tree, pipeline::LengthUnit::um));
  }
  void open(const std::optional<pipeline::Registration>& by_hand = {}) {
    display_.emplace(VesselDisplaySetup{.file = file_,
                                        .registration_file = {},
                                        .registration = by_hand,
                                        .operated = {},
                                        .live = true},
                     clock_, faults_, news_);
  }
  // Another volume after that time.
  void send(hal::Duration later) {
    clock_.advance(later);
    ++volume_.metadata.index;
    volume_.metadata.last_line = clock_.now();
    display_->advance(nullptr, actions_, &volume_);
    display_->trace(&volume_, actions_.state());
  }
  bool send_until(const std::function<bool()>& so) {
    for (int i = 0; i < 20'000; ++i) {
      if (so())
        return true;
      send(2ms);
      std::this_thread::sleep_for(1ms);
    }
    return false;
  }
  bool is(Followed::State state) const {
    return display_->status().followed && display_->status().followed->state == state;
  }
  bool is_registered() const {
    return is(Followed::State::followed) && display_->status().registered;
  }
  hal::Duration age() const { return display_->status().followed->age; }

  tests::ScratchFolder folder_;
  std::filesystem::path file_ = folder_ / "tree.swc";
  sim::VirtualClock clock_;
  pipeline::FaultLog faults_;
  pipeline::Wakeup news_;
  ui::ViewActions actions_{{}, {}, {ui::Action::b_scan}, {}};
  pipeline::Volume volume_;
  std::optional<VesselDisplay> display_;
};

TEST_F(FollowedVesselsTest, grow_old_are_marked_and_removed_while_nothing_can_be_traced) {
  open();
  ASSERT_TRUE(send_until([&] { return is_registered(); }));
  std::ranges::fill(volume_.flow, std::uint8_t{200}); // as of a patient who moves
  bool unregistered = false;
  // What was traced before may be registered still, as of then.
  for (int i = 0; i < 1000 && !is(Followed::State::removed); ++i) {
    send(1s);
    EXPECT_EQ(is(Followed::State::removed), age() >= Followed::removed_after);
    EXPECT_EQ(display_->status().registered, age() < Followed::unregistered_after);
    EXPECT_EQ(display_->status().state,
              age() < Followed::removed_after ? State::shown : State::none);
    unregistered = unregistered || (is(Followed::State::followed) && !is_registered());
  }
  EXPECT_TRUE(is(Followed::State::removed));
  EXPECT_TRUE(unregistered);
  volume_.flow = perfused(bed()).flow;
  EXPECT_TRUE(send_until([&] { return is_registered(); })) << "they flow again";
}

TEST_F(FollowedVesselsTest, of_a_frozen_picture_do_not_grow_old) {
  open();
  ASSERT_TRUE(send_until([&] { return is_registered(); }));
  actions_.perform(ui::Action::freeze, 1, ui::Done::pressed, clock_.now());
  clock_.advance(10min);
  display_->advance(nullptr, actions_, &volume_);
  EXPECT_LT(age(), Followed::removed_after);
  EXPECT_EQ(display_->status().state, State::shown);
}

TEST_F(FollowedVesselsTest, that_grow_too_old_are_again_where_a_person_put_them) {
  open(pipeline::Registration{});
  ASSERT_TRUE(send_until([&] { return is_registered(); }));
  send(Followed::removed_after);
  EXPECT_TRUE(is(Followed::State::removed)) << "and that is said";
  EXPECT_EQ(display_->status().state, State::shown);
}

} // namespace
} // namespace octascope::firmware_host
