// When a picture that is drawn in parts is drawn as a whole.
#include <algorithm>
#include <vector>

#include "tests/firmware-host/run/loop_stage.h"

namespace octascope::tests {
namespace {

using namespace std::chrono_literals;

class WholeFrames : public LoopStage {
protected:
  // Volumes come, each shown at once, and between two of them a picture of the microscope, if wanted.
  void run(int volumes, bool with_scope) {
    start({});
    send_volume(Tissue::usual);
    turn();
    display_.spoils = true;
    for (int i = 0; i < volumes; ++i) {
      if (with_scope)
        send_scope_picture();
      send_volume(i % 2 == 0 ? Tissue::reversed : Tissue::usual);
      turn();
      of_volumes_.push_back(display_.completed);
    }
  }
  bool shows_a_volume(hal::TimePoint frame) const {
    return std::ranges::find(of_volumes_, frame) != of_volumes_.end();
  }
  hal::Duration between(std::size_t i) const {
    return display_.whole_frames[i] - display_.whole_frames[i - 1];
  }

  std::vector<hal::TimePoint> of_volumes_;
};

TEST_F(WholeFrames, come_within_a_second_and_are_none_that_somebody_waits_for) {
  run(24, true);
  ASSERT_GE(display_.whole_frames.size(), 3U);
  for (std::size_t i = 1; i < display_.whole_frames.size(); ++i) {
    EXPECT_FALSE(shows_a_volume(display_.whole_frames[i])) << i;
    EXPECT_GE(between(i), 600ms) << i;
    EXPECT_LE(between(i), 900ms) << i;
  }
}

TEST_F(WholeFrames, are_those_of_volumes_where_there_are_no_others) {
  run(24, false);
  ASSERT_GE(display_.whole_frames.size(), 3U);
  for (std::size_t i = 1; i < display_.whole_frames.size(); ++i) {
    EXPECT_GE(between(i), 900ms) << i;
    EXPECT_LE(between(i), 900ms + plan().tick_period() + display_.refresh_period()) << i;
  }
}

} // namespace
} // namespace octascope::tests
