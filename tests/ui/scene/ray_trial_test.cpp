// What casts the rays is not decided by what else ran while it was tried.
#include <array>

#include "tests/ui/support/gl_test.h"
#include "ui/scene/ray_trial.h"

namespace octascope::tests {
namespace {

using namespace std::chrono_literals;

// Says that the pictures took these times, one after the other.
class PictureClock final : public hal::Clock {
public:
  using Times = std::array<hal::Duration, 8>;
  explicit PictureClock(const Times& times) : times_{times} {}

private:
  hal::TimePoint do_now() const override {
    if (looks_++ % 2 == 1)
      now_ += times_.at(pictures_++);
    return now_;
  }
  void do_sleep_until(hal::TimePoint) override { FAIL(); }
  bool do_wait_until(hal::Semaphore&, hal::TimePoint) override { return false; }

  Times times_;
  mutable std::size_t pictures_ = 0;
  mutable int looks_ = 0;
  mutable hal::TimePoint now_;
};

class RayTrialTest : public GlTest {};

TEST_F(RayTrialTest, takes_the_least_time_of_either) {
  // Of the processor, of the shader, and so on.
  const PictureClock clock{{80ms, 70ms, 31ms, 12ms, 2ms, 90ms, 31ms, 60ms}};
  const auto trial = ui::try_ray_backends(clock);
  ASSERT_TRUE(trial) << trial.error().message;
  EXPECT_EQ(trial->processor, 2ms);
  EXPECT_EQ(trial->shader, 12ms);
  EXPECT_EQ(trial->faster(), ui::RayBackend::processor);
}

} // namespace
} // namespace octascope::tests
