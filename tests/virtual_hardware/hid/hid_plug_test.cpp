// Controls that come and go.
#include <array>
#include <cstdio>

#include "tests/virtual_hardware/hid/hid_bench.h"
#include "tests/virtual_hardware/support/resource_count.h"

namespace octascope::tests {
namespace {

using hal::ErrorCode;
using namespace std::chrono_literals;

class HidPlug : public HidTest {
protected:
  // What is read until `count` controls serve; fails after 10 s.
  Moves read_until_serving(std::size_t count) {
    Moves moves;
    const hal::TimePoint limit = clock_.now() + 10s;
    while (controls_.serving().size() != count && clock_.now() < limit)
      for (const Move& move : read_all())
        moves.push_back(move);
    EXPECT_EQ(controls_.serving().size(), count);
    return moves;
  }
  // Reads until it fails.
  hal::Error read_to_the_end(Moves& moves) {
    std::array<hal::ControlEvent, 4> events;
    while (true) {
      const auto count = controls_.read(events, 10s);
      if (!count)
        return count.error();
      if (*count == 0)
        return {ErrorCode::timed_out, "nothing happened"};
      for (const hal::ControlEvent& event : std::span{events}.first(*count))
        moves.push_back({event.kind, event.index, event.value});
    }
  }
};

TEST_F(HidPlug, a_knob_completes_a_pedal_that_has_none) {
  const auto knob = plug_in_knob(); // first: the order of plugging does not matter
  const auto pedal = plug_in(vec_pedal());
  ASSERT_TRUE(knob && pedal);
  ASSERT_TRUE(controls_.open());
  const auto serving = controls_.serving();
  ASSERT_EQ(serving.size(), 2U);
  EXPECT_EQ(serving[0].control.model.model, "vec_infinity");
  EXPECT_EQ(serving[1].control.model.model, "powermate");
  EXPECT_EQ(serving[1].place.first_switch, 3);
  EXPECT_TRUE(pedal->send({0x02, 0}));
  EXPECT_EQ(read_all(), (Moves{pressed(1)}));
  EXPECT_TRUE(knob->turn(2));
  EXPECT_EQ(read_all(), (Moves{turned(2)}));
  EXPECT_TRUE(knob->press(true));
  EXPECT_EQ(read_all(), (Moves{pressed(3)}));
}

TEST_F(HidPlug, a_pedal_that_comes_later_joins_and_leads) {
  const auto knob = plug_in_knob();
  ASSERT_TRUE(knob);
  ASSERT_TRUE(controls_.open());
  EXPECT_TRUE(knob->press(true));
  EXPECT_EQ(read_all(), (Moves{pressed(0)}));
  const std::uint64_t changes = controls_.changes();

  const auto pedal = plug_in(vec_pedal());
  ASSERT_TRUE(pedal);
  EXPECT_EQ(read_until_serving(2), (Moves{released(0)})) << "numbers are given anew";
  EXPECT_GT(controls_.changes(), changes);
  EXPECT_EQ(controls_.serving()[0].control.model.model, "vec_infinity");
  EXPECT_TRUE(knob->press(false));
  EXPECT_EQ(read_all(), Moves{});
  EXPECT_TRUE(pedal->send({0x01, 0}));
  EXPECT_EQ(read_all(), (Moves{pressed(0)}));
  EXPECT_TRUE(knob->press(true));
  EXPECT_EQ(read_all(), (Moves{pressed(3)}));
}

TEST_F(HidPlug, when_one_of_two_goes_the_other_serves_on_after_reopening) {
  auto knob = plug_in_knob();
  const auto pedal = plug_in(vec_pedal());
  ASSERT_TRUE(knob && pedal);
  ASSERT_TRUE(controls_.open());
  EXPECT_TRUE(pedal->send({0x01, 0}));
  EXPECT_TRUE(knob->press(true));
  EXPECT_EQ(read_all().size(), 2U);
  knob.reset();
  Moves moves;
  EXPECT_EQ(read_to_the_end(moves).code, ErrorCode::disconnected);
  EXPECT_EQ(moves, (Moves{released(0), released(3)}));
  controls_.close();
  EXPECT_TRUE(controls_.serving().empty());
  ASSERT_TRUE(controls_.open());
  EXPECT_TRUE(pedal->send({0x03, 0}));
  EXPECT_EQ(read_all(), (Moves{pressed(0), pressed(1)}));
}

TEST_F(HidPlug, a_puck_pulled_out_while_pushed_is_centred) {
  auto puck = plug_in(space_navigator());
  ASSERT_TRUE(puck);
  ASSERT_TRUE(controls_.open());
  EXPECT_TRUE(puck->send({1, 0x5e, 0x01, 0, 0, 0, 0}));
  EXPECT_TRUE(puck->send({3, 0x01, 0x00}));
  EXPECT_EQ(read_all(), (Moves{pushed(0, 1000), pressed(0)}));
  puck.reset();
  Moves moves;
  EXPECT_EQ(read_to_the_end(moves).code, ErrorCode::disconnected);
  EXPECT_EQ(moves, (Moves{released(0), pushed(0, 0)}));
}

// Every second time it goes while it is open and pressed.
TEST_F(HidPlug, many_plug_cycles_leak_nothing) {
  const auto cycle = [&](int i) {
    auto pedal = i % 3 == 0 ? plug_in(pcsensor_pedal()) : plug_in(vec_pedal());
    auto knob = i % 4 == 0 ? plug_in_knob() : nullptr;
    ASSERT_TRUE(pedal);
    ASSERT_TRUE(controls_.open());
    ASSERT_TRUE(i % 3 == 0 ? pedal->send({1, 0, 0, 5, 0, 0, 0, 0, 0}) : pedal->send({1, 0}));
    std::array<hal::ControlEvent, 4> events;
    ASSERT_EQ(controls_.read(events, 5s).value(), 1U);
    if (i % 2 == 0)
      controls_.close();
    pedal.reset();
    if (i % 2 != 0) {
      Moves moves;
      ASSERT_EQ(read_to_the_end(moves).code, ErrorCode::disconnected);
      ASSERT_EQ(moves, (Moves{released(0)}));
      controls_.close();
    }
  };
  cycle(0);
  cycle(1);
  const ResourceCount before = resources_in_use();
  // The heap's caches fill (some 14 kB, then hardly more in further rounds): what a cycle leaks of
  // it shows in the second half.
  for (int i = 0; i < leak_cycles() / 2 && !HasFatalFailure(); ++i)
    cycle(i);
  const ResourceCount halfway = resources_in_use();
  for (int i = 0; i < leak_cycles() / 2 && !HasFatalFailure(); ++i)
    cycle(i);
  const ResourceCount after = expect_no_leak(halfway, {.mappings = 2});
  EXPECT_EQ(after.descriptors, before.descriptors);
  EXPECT_LE(after.mappings, before.mappings + 2);
}

} // namespace
} // namespace octascope::tests
