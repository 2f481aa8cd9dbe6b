// What the watchdog is kicked by: pictures that were seen and are true, and nothing else.
#include "tests/firmware-host/run/loop_stage.h"

namespace octascope::tests {
namespace {

using namespace std::chrono_literals;

class Proof : public LoopStage {
protected:
  void SetUp() override {
    LoopStage::SetUp();
    if (!IsSkipped())
      start({});
  }
};

TEST_F(Proof, comes_at_least_once_a_second_of_a_picture_that_does_not_change) {
  turn_until(clock_.now() + 3s);
  for (int i = 0; i < 5; ++i) {
    const auto before = proof_.frames();
    turn_until(clock_.now() + 1s);
    EXPECT_GE(proof_.frames(), before + 1) << "second " << i;
    EXPECT_LE(proof_.frames(), before + 20) << "and not with every refresh";
  }
  EXPECT_EQ(proof_.frames(), proof_.steps());
}

TEST_F(Proof, does_not_come_of_pictures_that_nobody_sees) {
  send_volume(Tissue::usual);
  turn();
  display_.covered = true;
  const auto before = proof_.steps();
  const auto drawn = loop_->statistics().frames_drawn;
  send_volume(Tissue::reversed);
  turn_until(clock_.now() + 5s);
  EXPECT_EQ(proof_.steps(), before);
  EXPECT_EQ(loop_->statistics().frames_drawn, drawn);
  EXPECT_EQ(loop_->statistics().volumes_displayed, 1U);
  display_.covered = false;
  turn_until(clock_.now() + 1s);
  EXPECT_GT(proof_.frames(), before);
  EXPECT_EQ(loop_->statistics().volumes_displayed, 2U) << "now it is seen";
}

TEST_F(Proof, goes_on_while_there_is_no_monitor) {
  display_.cable().lose();
  turn_until(clock_.now() + 2s);
  const auto frames = proof_.frames();
  auto before = proof_.steps();
  for (int i = 0; i < 100; ++i, before = proof_.steps()) {
    turn_until(clock_.now() + 3s);
    EXPECT_GT(proof_.steps(), before) << "it is looked for: a restart would not help";
  }
  EXPECT_EQ(proof_.frames(), frames);
  display_.cable().restore();
  turn_until(clock_.now() + 3s);
  EXPECT_GT(proof_.frames(), frames);
}

TEST_F(Proof, ends_when_a_display_that_is_there_does_not_open_for_long) {
  display_.refusal = hal::Error{hal::ErrorCode::system, "the driver is confused"};
  display_.cable().lose();
  turn_until(clock_.now() + 2s);
  auto before = proof_.steps();
  turn_until(clock_.now() + 10s);
  EXPECT_GT(proof_.steps(), before) << "it is tried for a while";
  turn_until(clock_.now() + 30s);
  before = proof_.steps();
  turn_until(clock_.now() + 60s);
  EXPECT_EQ(proof_.steps(), before) << "now a restart may help";
}

} // namespace
} // namespace octascope::tests
